/* Flights of dumbbells in boxes that are periodic or sheared. */
#include "fluid/dumbbell.h"

#include "wall/motion.h"

struct pairs pairs_of(const struct state *state, uint32_t first, uint32_t n)
{
  const struct solvent *s = &state->solvent;
  const struct dumbbells *d = &state->dumbbells;
  const size_t at = 2 * (size_t)first;
  return (struct pairs){n,
                        {s->x + at, s->y + at, s->z + at},
                        {s->vx + at, s->vy + at, s->vz + at},
                        {d->x + first, d->y + first, d->z + first}};
}

/* A sum of int64 may not wrap; that of a flight out of range does. */
static inline int64_t moved(int64_t x, int64_t d)
{
  return (int64_t)((uint64_t)x + (uint64_t)d);
}

static inline int64_t one_edge_in(int64_t x, int64_t edge)
{
  x = moved(x, x < 0 ? edge : 0);
  return moved(x, x >= edge ? -edge : 0);
}

int64_t pairs_fly(const struct pairs *pairs, int axis, const struct swing *swing, double a, int64_t edge)
{
  int64_t *restrict x = pairs->at[axis], *restrict apart = pairs->apart[axis];
  double *restrict v = pairs->v[axis];
  const struct swing s = *swing;
  const double free = 0.5 * a * s.time * s.time, gain = a * s.time;
  const size_t n = pairs->n;
  int64_t outside = 0, far = 0;
  for (size_t p = 0; p < n; p++) {
    const double r = pairs_real(apart[p]) * LATTICE_UNIT, u = v[2 * p] - v[2 * p + 1];
    const double mean = 0.5 * (v[2 * p] + v[2 * p + 1]), center = mean * s.time + free;
    const double half = s.return_r * r + s.advance_u * u;
    const int64_t d0 = lattice_from_a0(center + half), d1 = lattice_from_a0(center - half);
    const double change = s.pull_r * r + s.keep_u * u, after = mean + gain;
    const int64_t x0 = one_edge_in(moved(x[2 * p], d0), edge), x1 = one_edge_in(moved(x[2 * p + 1], d1), edge);
    far |= (fabs(center) + fabs(half) < LATTICE_MAX_MOVE ? 0 : 1) | ((apart[p] + LONGEST) & ~(2 * LONGEST - 1));
    outside |= x0 | x1 | moved(edge - 1, -x0) | moved(edge - 1, -x1);
    apart[p] = moved(apart[p], moved(d0, -d1));
    x[2 * p] = x0, x[2 * p + 1] = x1;
    v[2 * p] = after + change, v[2 * p + 1] = after - change;
  }
  for (uint32_t i = 0; edge && outside < 0 && i < 2 * pairs->n; i++)
    x[i] = lattice_fold(x[i], edge);
  return far;
}

/* --- periodic ---------------------------------------------------------------------------------------------------- */

static int64_t fly_periodic(const struct pairs *pairs, const struct model *model, const struct span *span,
                            const struct swing *swing, struct account account)
{
  (void)account;
  const double a[3] = {span->acceleration.x, span->acceleration.y, span->acceleration.z};
  int64_t far = 0;
  for (int k = 0; k < 3; k++)
    far |= pairs_fly(pairs, k, swing, a[k], model->box.edge[k]);
  return far;
}

const struct dumbbell_boundary dumbbells_periodic = {"periodic", fly_periodic};

/* --- sheared ----------------------------------------------------------------------------------------------------- */

/* A dumbbell across the boundary: its second particle is in the box, and its image next to the first one is not. The
 * number of that image along y; 0 for most dumbbells. */
static inline int64_t second_image(const struct pairs *pairs, uint32_t p, int64_t edge)
{
  const int64_t apart = pairs->at[1][2 * p] - pairs->apart[1][p] - pairs->at[1][2 * p + 1];
  return apart == 0 ? 0 : apart / edge;
}

/* Moves the second particles of dumbbells across the boundary to the images next to the first ones, as far as x and v_x
 * are concerned; sign -1: and back. y is left as it is. */
static void change_images(const struct pairs *pairs, const struct box *box, struct slide slide, int sign)
{
  for (uint32_t p = 0; p < pairs->n; p++) {
    const int64_t image = sign * second_image(pairs, p, box->edge[1]);
    if (image == 0)
      continue;
    int64_t *x = &pairs->at[0][2 * p + 1];
    *x = lattice_fold(moved(*x, image * slide.offset), box->edge[0]);
    pairs->v[0][2 * p + 1] += (double)image * slide.speed;
  }
}

static int64_t fly_sheared(const struct pairs *pairs, const struct model *model, const struct span *span,
                           const struct swing *swing, struct account account)
{
  (void)account;
  const struct vec3 a = span->acceleration;
  const struct box *box = &model->box;
  const struct slide end = boundary_slide(model, span->end, span->interval);
  change_images(pairs, box, boundary_slide(model, span->begin, span->interval), 1);
  int64_t far = pairs_fly(pairs, 0, swing, a.x, box->edge[0]);
  far |= pairs_fly(pairs, 1, swing, 0.0, 0);
  far |= pairs_fly(pairs, 2, swing, a.z, box->edge[2]);
  if (far)
    return far;
  change_images(pairs, box, end, -1);
  for (uint32_t i = 0; i < 2 * pairs->n; i++)
    boundary_bring_in(box, end, &pairs->at[0][i], &pairs->at[1][i], &pairs->v[0][i]);
  return 0;
}

const struct dumbbell_boundary dumbbells_sheared = {"shear", fly_sheared};

const struct dumbbell_boundary *dumbbell_boundary_of(const struct box *box)
{
  static const struct dumbbell_boundary *const boundaries[BOUNDARIES] = {[BOUNDARY_PERIODIC] = &dumbbells_periodic,
                                                                         [BOUNDARY_WALL] = &dumbbells_between_walls,
                                                                         [BOUNDARY_SHEAR] = &dumbbells_sheared};
  return boundaries[box->boundary[1]];
}
