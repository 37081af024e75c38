/*
 * Collisions around a bead.
 *
 * Flights. All particles have flown as if there were no bead, and are in the sums of their cells. Who may have met it
 * is known from the cells: a particle that touches the bead in its flight ends within reach of it, and the largest
 * momentum that the sums have met bounds that reach. The few particles that do meet it (fluid/bead.c) are taken out of
 * the sums, which are integers, get their true places and velocities, and are added again.
 *
 * Virtual particles. A cell that the surface cuts holds particles of mass 1 in the part inside: of a Poisson number of
 * mean gamma, uniform in the cell, those count that are inside. They are a part of the bead's own matter, which has the
 * mass M, the total momentum M V and the temperature kT. So their mean velocity in cell i, n_i of them, is
 *
 *   v_i = V + g_i - (sum_j n_j g_j + m_0 g_0)/M,   g_i normal of variance kT/n_i,   m_0 = M - sum_j n_j, g_0: kT/m_0
 *
 * per component: drawn anew at the given total momentum. The bead takes what they gain: V += sum_i n_i (v_i' - v_i)/M.
 * With independent velocities (no last term) the bead would be too hot, by about half of sum n/M. Cells without other
 * members are left out, and cells beyond those whose particles have together the mass M.
 */
#include "system/bead.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/normal.h"
#include "mpc/cell.h"
#include "mpc/grid.h"
#include "mpc/rule.h"
#include "mpc/virtual.h"

/* --- cells around the bead --------------------------------------------------------------------------------------- */

/* Cells of the shifted grid around a point: numbers along each axis, not folded; and the point in these numbers. */
struct surround {
  int64_t low[3], high[3]; /* both included */
  double center[3];        /* cell i reaches from i to i + 1 */
};

/* All cells with a part within a distance of the bead. */
static struct surround surround_of(const struct bead *bead, const struct model *model, const struct mpc *c,
                                   double distance)
{
  const int64_t at[3] = {bead->position.x, bead->position.y, bead->position.z};
  const int64_t shift[3] = {c->shift.x, c->shift.y, c->shift.z};
  struct surround s;
  for (int k = 0; k < 3; k++) {
    s.center[k] = (double)(lattice_fold(at[k], model->box.edge[k]) + shift[k]) * LATTICE_UNIT;
    s.low[k] = (int64_t)floor(s.center[k] - distance);
    s.high[k] = (int64_t)floor(s.center[k] + distance);
  }
  return s;
}

static uint32_t folded(int64_t i, int cells)
{
  return (uint32_t)(i < 0 ? i + cells : i >= cells ? i - cells : i);
}

/* Number of a cell. */
static uint32_t cell_at(const struct box *box, int64_t x, int64_t y, int64_t z)
{
  return (folded(z, box->cells[2]) * (uint32_t)box->cells[1] + folded(y, box->cells[1])) * (uint32_t)box->cells[0] +
         folded(x, box->cells[0]);
}

/* Of the interval of a cell along an axis, from the center: square of the least and of the largest distance. */
static double least_square(const struct surround *s, int k, int64_t i)
{
  const double below = (double)i - s->center[k], above = s->center[k] - (double)(i + 1);
  const double d = fmax(0.0, fmax(below, above));
  return d * d;
}

static double largest_square(const struct surround *s, int k, int64_t i)
{
  const double d = fmax(fabs((double)i - s->center[k]), fabs((double)(i + 1) - s->center[k]));
  return d * d;
}

/* --- flights ----------------------------------------------------------------------------------------------------- */

/* Marks the cells within a distance of the bead, or clears their marks. */
static void mark(const struct surround *s, const struct model *model, struct mpc *c, double distance, uint8_t value)
{
  const double most = distance * distance;
  for (int64_t z = s->low[2]; z <= s->high[2]; z++)
    for (int64_t y = s->low[1]; y <= s->high[1]; y++) {
      const double square = least_square(s, 2, z) + least_square(s, 1, y);
      for (int64_t x = s->low[0]; x <= s->high[0]; x++)
        if (square + least_square(s, 0, x) <= most)
          c->bead.mask[cell_at(&model->box, x, y, z)] = value;
    }
}

enum { GROUP = 32 }; /* particles looked at together: among most groups no one is near */

/* Numbers of cells in layers z = low .. high: those from `first` on, `span` of them, and the first `wrapped` ones. */
struct layers {
  uint32_t first, span, wrapped;
};

static struct layers layers_of(const struct surround *s, const struct box *box)
{
  const uint32_t each = (uint32_t)(box->cells[0] * box->cells[1]), all = (uint32_t)box->cells[2];
  const uint32_t first = folded(s->low[2], box->cells[2]), n = (uint32_t)(s->high[2] - s->low[2] + 1);
  const uint32_t over = first + n > all ? first + n - all : 0;
  return (struct layers){first * each, (n - over) * each, over * each};
}

static bool any_in(const uint32_t *cell, uint32_t n, struct layers layers)
{
  uint32_t any = 0;
  for (uint32_t k = 0; k < n; k++)
    any |= (uint32_t)(cell[k] - layers.first < layers.span) | (uint32_t)(cell[k] < layers.wrapped);
  return any;
}

/* Places of particles in marked cells, into c->order. Returns their number. */
static uint32_t find_near(const struct state *state, struct mpc *c, struct layers layers)
{
  const uint32_t n = state->solvent.n;
  uint32_t found = 0;
  for (uint32_t first = 0; first < n; first += GROUP) {
    const uint32_t m = n - first < GROUP ? n - first : GROUP, *cell = &c->solvent_cell[first];
    if (!any_in(cell, m, layers))
      continue;
    for (uint32_t k = 0; k < m; k++)
      if (c->bead.mask[cell[k]])
        c->order[found++] = first + k;
  }
  return found;
}

/* What a particle adds to its cell: the rule says it, into a sum that is empty. */
static struct cell_sum share_of(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                                uint32_t i, uint64_t *span)
{
  struct cell_sum *sum = &c->sum[c->solvent_cell[i]];
  const struct cell_sum kept = *sum;
  memset(sum, 0, sizeof *sum);
  *span |= c->rule->add_particles(state, model, c, step, i, 1);
  const struct cell_sum share = *sum;
  *sum = kept;
  return share;
}

static void take_out(struct cell_sum *sum, struct cell_sum share)
{
  sum->px = (int64_t)((uint64_t)sum->px - (uint64_t)share.px);
  sum->py = (int64_t)((uint64_t)sum->py - (uint64_t)share.py);
  sum->pz = (int64_t)((uint64_t)sum->pz - (uint64_t)share.pz);
  sum->load -= share.load;
}

static void write_flight(struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                         const struct bead_visit *m, uint64_t *span)
{
  struct solvent *s = &state->solvent;
  const uint32_t i = m->place;
  uint64_t known = 0;
  take_out(&c->sum[c->solvent_cell[i]], share_of(state, model, c, step, i, &known));
  s->x[i] = m->at.x, s->y[i] = m->at.y, s->z[i] = m->at.z;
  s->vx[i] = m->velocity.x, s->vy[i] = m->velocity.y, s->vz[i] = m->velocity.z;
  c->border->bin_particles(state, model, i, 1, c);
  *span |= c->rule->add_particles(state, model, c, step, i, 1);
}

#define DRAWN 7.6 /* a0/t0: a rule that draws velocities adds their difference to the sums; none is larger */
#define SLACK 0.5 /* a0/t0: of the bead's velocity in a flight, at first */
#define SQRT3 1.7320508075688773

/* a0/t0: no particle is faster. A bound that costs nothing. */
static double fastest(const struct mpc *c, uint64_t span)
{
  return SQRT3 * ((double)span * CELL_MOMENTUM_UNIT + (c->rule->thermal ? DRAWN : 0.0));
}

/* The same, found by looking at all of them; no number is larger than any. */
static double fastest_of_all(const struct solvent *s)
{
  double most = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    const struct vec3 v = solvent_velocity(s, i);
    most = vec3_dot(v, v) <= most ? most : vec3_dot(v, v);
  }
  return sqrt(most);
}

/* How far from where the bead was a particle may end that has met it. */
static double reach_of(const struct state *state, const struct model *model, double slack, double speed)
{
  const double time = 0.5 * state->solvent_lag * model->time_step;
  return model->bead.radius + slack + time * (speed + vec3_norm(state->bead->velocity)) + 1e-3;
}

/* Who meets the bead if it is off its free flight by `slack` at most. False, with the fault recorded, if an image may
 * be met as well. */
static bool meet(const struct state *state, const struct model *model, struct mpc *c, uint64_t step, double slack,
                 double speed, struct fault *fault)
{
  const double most = 0.5 * box_shortest_edge(&model->box) - 1.0;
  double reach = reach_of(state, model, slack, speed);
  if (!(reach < most))
    reach = reach_of(state, model, slack, fastest_of_all(&state->solvent));
  if (!(reach < most))
    return fault_record(fault, FAULT_BEAD_MOVE, step, 0, reach, most);
  const struct surround s = surround_of(state->bead, model, c, reach);
  mark(&s, model, c, reach, 1);
  const uint32_t near = find_near(state, c, layers_of(&s, &model->box));
  mark(&s, model, c, reach, 0);
  return c->fluid->meet(state, model, c->order, near, slack, &c->bead.meetings, fault);
}

static bool rebound(struct state *state, const struct model *model, struct mpc *c, uint64_t step, uint64_t *span,
                    struct fault *fault)
{
  struct bead_visits *all = &c->bead.meetings;
  const double speed = fastest(c, *span), time = 0.5 * state->solvent_lag * model->time_step;
  double slack = SLACK * time;
  do {
    if (!meet(state, model, c, step, slack, speed, fault))
      return false;
    slack *= 2.0;
  } while (!all->enough);
  for (const struct bead_visit *m = all->at; m < all->at + all->n; m++)
    write_flight(state, model, c, step, m, span);
  *state->bead = all->bead;
  return true;
}

/* --- virtual particles ------------------------------------------------------------------------------------------- */

struct bead_cut {
  uint32_t cell, n; /* place in sum and turn; particles inside */
  struct virtual_members members;
};

/* Of the virtual particles of a cell, those inside the bead. corner: of the cell, from the bead's center, a0. */
static uint32_t count_inside(const struct model *model, uint64_t step, uint32_t cell, const double corner[3])
{
  const uint32_t n = virtual_number(model, step, cell, model->solvent.per_cell);
  const double square = model->bead.radius * model->bead.radius;
  uint32_t inside = 0;
  for (uint32_t k = 0; k < n; k++) {
    const struct random_words r = random_at(model->seed, RANDOM_BEAD_PLACE, k, step, cell);
    double d = 0.0;
    for (int axis = 0; axis < 3; axis++) {
      const double x = corner[axis] + ((double)r.w[axis] + 0.5) * 0x1p-32;
      d += x * x;
    }
    inside += d < square;
  }
  return inside;
}

static bool add_cut(struct mpc_bead *b, uint32_t cell, uint32_t n, uint64_t step, struct fault *fault)
{
  if (b->cuts == b->cut_room && !memory_double((void **)&b->cut, &b->cut_room, 256, sizeof *b->cut))
    return fault_no_memory(fault, step);
  b->cut[b->cuts++] = (struct bead_cut){.cell = cell, .n = n};
  return true;
}

/* All of one line of cells along x. */
static bool cut_line(const struct surround *s, const struct model *model, struct mpc *c, int64_t y, int64_t z,
                     uint64_t step, struct fault *fault)
{
  const double square = model->bead.radius * model->bead.radius;
  const double least = least_square(s, 2, z) + least_square(s, 1, y);
  const double largest = largest_square(s, 2, z) + largest_square(s, 1, y);
  for (int64_t x = s->low[0]; x <= s->high[0]; x++) {
    if (!(least + least_square(s, 0, x) < square && largest + largest_square(s, 0, x) > square))
      continue;
    const uint32_t cell = cell_at(&model->box, x, y, z);
    if (cell_members(&c->sum[cell]) == 0)
      continue;
    const double corner[3] = {(double)x - s->center[0], (double)y - s->center[1], (double)z - s->center[2]};
    const uint32_t n = count_inside(model, step, cell, corner);
    if (n > 0 && !add_cut(&c->bead, cell, n, step, fault))
      return false;
  }
  return true;
}

/* Cells whose particles have more than the mass of the bead together are dropped. Returns what is left of the mass. */
static double rest_mass(const struct model *model, struct mpc_bead *b)
{
  double rest = model->bead.mass;
  uint32_t kept = 0;
  while (kept < b->cuts && b->cut[kept].n <= rest)
    rest -= b->cut[kept++].n;
  b->cuts = kept;
  return rest;
}

/* Velocities of the virtual particles, at the total momentum of the bead. */
static bool draw_velocities(const struct bead *bead, const struct model *model, struct mpc_bead *b, uint64_t step,
                            struct fault *fault)
{
  const double rest = rest_mass(model, b);
  struct vec3 *normal = malloc(((size_t)b->cuts + 1) * sizeof *normal);
  uint32_t *cell = malloc(((size_t)b->cuts + 1) * sizeof *cell);
  if (normal && cell) {
    double own[3];
    random_normal_three(random_at(model->seed, RANDOM_BEAD_REST, 0, step, 0), own);
    struct vec3 sum = vec3_scale(sqrt(rest), (struct vec3){own[0], own[1], own[2]});
    for (uint32_t k = 0; k < b->cuts; k++)
      cell[k] = b->cut[k].cell;
    virtual_normals(model, step, cell, b->cuts, normal);
    for (uint32_t k = 0; k < b->cuts; k++)
      sum = vec3_add_scaled(sum, sqrt(b->cut[k].n), normal[k]);
    const struct vec3 flow = vec3_add_scaled(bead->velocity, -1.0 / model->bead.mass, sum);
    for (uint32_t k = 0; k < b->cuts; k++)
      b->cut[k].members = (struct virtual_members){
          .n = b->cut[k].n, .velocity = virtual_velocity(normal[k], b->cut[k].n, flow), .flow = flow};
  }
  const bool ok = normal && cell;
  free(normal);
  free(cell);
  return ok || fault_no_memory(fault, step);
}

static bool fill(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                 struct fault *fault)
{
  const struct surround s = surround_of(state->bead, model, c, model->bead.radius);
  c->bead.cuts = 0;
  for (int64_t z = s.low[2]; z <= s.high[2]; z++)
    for (int64_t y = s.low[1]; y <= s.high[1]; y++)
      if (!cut_line(&s, model, c, y, z, step, fault))
        return false;
  if (!draw_velocities(state->bead, model, &c->bead, step, fault))
    return false;
  for (const struct bead_cut *cut = c->bead.cut; cut < c->bead.cut + c->bead.cuts; cut++) {
    if (!virtual_room(&c->sum[cut->cell], cut->n, step, cut->cell, FAULT_SOLVENT_SPEED, fault))
      return false;
    c->rule->add_virtual(model, c, step, cut->cell, &cut->members);
  }
  return true;
}

/* The bead takes the momentum that its virtual particles gain. They keep the energy that they have gained: what the
 * bead gains beyond that is heat from its matter. */
static void account(struct state *state, const struct model *model, struct mpc *c, uint64_t step)
{
  struct point sum = {0, 0, 0};
  uint64_t turns = 0;
  struct bead *bead = state->bead;
  int64_t taken = 0;
  for (const struct bead_cut *cut = c->bead.cut; cut < c->bead.cut + c->bead.cuts; cut++) {
    const struct vec3 gain = c->rule->virtual_gain(model, c, step, cut->cell, &cut->members, false);
    account_add(&sum, &turns, gain);
    bead_account(&taken, vec3_dot(gain, vec3_add_scaled(cut->members.velocity, 0.5 / cut->n, gain)));
  }
  const struct vec3 gain = account_between((struct point){0, 0, 0}, sum);
  bead_account(&bead->account.x, vec3_dot(gain, vec3_add_scaled(bead->velocity, 0.5 / model->bead.mass, gain)));
  bead->account.x = (int64_t)((uint64_t)bead->account.x - (uint64_t)taken);
  bead->velocity = vec3_add_scaled(bead->velocity, 1.0 / model->bead.mass, gain);
}

const struct border border_bead = {.name = "bead",
                                   .bin_particles = grid_bin_particles,
                                   .bin_vertices = grid_bin_vertices,
                                   .rebound = rebound,
                                   .fill = fill,
                                   .account = account};
