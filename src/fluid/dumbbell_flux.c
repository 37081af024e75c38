/*
 * The stress that dumbbells carry in flight (Tao, Goetze and Gompper 2008): momentum that moves with their particles,
 * and the pull of their springs.
 *
 * A flight is followed back from its end. A time s before it the vector was r cos(w s) - (u/w) sin(w s), and its
 * velocity u cos(w s) + w r sin(w s): r, u and the velocity relative to a linear flow are all of the form
 * f(s) = c cos(w s) + d sin(w s). Over a flight of time t
 *
 *   <f g> = c c' <cos^2> + d d' <sin^2> + (c d' + d c') <sin cos>,
 *   <cos^2> = 1/2 + sin(2 w t)/(4 w t),  <sin^2> = 1 - <cos^2>,  <sin cos> = sin^2(w t)/(2 w t)
 *
 * With w = u - rate r_y, the velocity of the vector relative to the flow, the two particles carry 2 W_a W_b + w_a w_b/2
 * on average, W that of their center. The heat of a flight is then rate times -(2 W_x W_y + w_x w_y/2) + K r_x r_y,
 * exactly.
 */
#include "fluid/dumbbell.h"

/* One component: c, d of the above. */
struct swayed {
  double cosine, sine;
};

/* <cos^2>, <sin^2>, <sin cos>. */
struct mean {
  double cc, ss, cs;
};

static struct mean mean_over(double frequency, double time)
{
  const double turns_per_radian = 0x1.45f306dc9c883p-3; /* 1/(2 pi) */
  const struct circle_point at = elementary_circle_turns(frequency * time * turns_per_radian);
  const double angle = frequency * time, cc = 0.5 + 0.5 * at.sine * at.cosine / angle;
  return (struct mean){cc, 1.0 - cc, 0.5 * at.sine * at.sine / angle};
}

static double product(struct swayed f, struct swayed g, const struct mean *m)
{
  return f.cosine * g.cosine * m->cc + f.sine * g.sine * m->ss + (f.cosine * g.sine + f.sine * g.cosine) * m->cs;
}

static double value(struct swayed f, struct circle_point at)
{
  return f.cosine * at.cosine + f.sine * at.sine;
}

/* A dumbbell at the end of a flight. */
struct swinging {
  double height;                   /* of the center, a0 */
  struct vec3 center;              /* its velocity, of the laboratory, a0/t0 */
  struct swayed apart[3], rate[3]; /* r, a0; w of the above, a0/t0 */
};

/* Of the image next to its first particle. */
static struct swinging swinging_at(const struct state *state, const struct model *model, const struct flux_frame *frame,
                                   uint32_t p)
{
  const struct solvent *s = &state->solvent;
  const struct dumbbells *d = &state->dumbbells;
  const int64_t edge = model->box.edge[1];
  int64_t y[2];
  for (int i = 0; i < 2; i++)
    y[i] = s->y[2 * p + i] - (s->y[2 * p + i] >= frame->beyond ? edge : 0);
  const int64_t image = (y[0] - d->y[p] - y[1]) / edge; /* of the second */
  const double w = model->dumbbells.frequency, per = 1.0 / w;
  const struct vec3 r = point_in_a0((struct point){d->x[p], d->y[p], d->z[p]}), v = solvent_velocity(s, 2 * p);
  const struct vec3 other =
      vec3_add_scaled(solvent_velocity(s, 2 * p + 1), (double)image * model->box.cells[1], frame->rate);
  const struct vec3 u = vec3_sub(v, other), g = frame->rate;
  return (struct swinging){
      (double)y[0] * LATTICE_UNIT - 0.5 * r.y,
      vec3_scale(0.5, vec3_add(v, other)),
      {{r.x, -per * u.x}, {r.y, -per * u.y}, {r.z, -per * u.z}},
      {{u.x - g.x * r.y, w * r.x + per * g.x * u.y}, {u.y, w * r.y}, {u.z - g.z * r.y, w * r.z + per * g.z * u.y}}};
}

static const int axes[STRESS_COMPONENTS][2] = {
    [STRESS_XY] = {0, 1}, [STRESS_XX] = {0, 0}, [STRESS_YY] = {1, 1}, [STRESS_ZZ] = {2, 2}};

/* --- without walls ----------------------------------------------------------------------------------------------- */

static void add_mean(const struct swinging *b, const struct flux_frame *frame, double spring, const struct mean *mean,
                     struct flux_sum *sum)
{
  const double middle = b->height - 0.5 * frame->time * b->center.y;
  const struct vec3 center = vec3_sub(b->center, vec3_add_scaled(frame->at_zero, middle, frame->rate));
  const double w[3] = {center.x, center.y, center.z};
  sum->n += 2;
  sum->wx += flux_fixed(2.0 * center.x), sum->wy += flux_fixed(2.0 * center.y), sum->wz += flux_fixed(2.0 * center.z);
  for (int k = 0; k < STRESS_COMPONENTS; k++) {
    const int i = axes[k][0], j = axes[k][1];
    sum->product[k] += flux_fixed(2.0 * w[i] * w[j] + 0.5 * product(b->rate[i], b->rate[j], mean));
    sum->spring[k] += flux_fixed(spring * product(b->apart[i], b->apart[j], mean));
  }
}

/* --- between walls ----------------------------------------------------------------------------------------------- */

/* The share of a line from low to low + rise that is in the bulk. */
static double share_in_bulk(double low, double rise, double edge)
{
  const double inside = fmin(low + rise, edge - 1.0) - fmax(low, 1.0);
  return inside <= 0.0 ? 0.0 : rise > inside ? inside / rise : 1.0;
}

static void add_middle(const struct swinging *b, const struct flux_frame *frame, double spring,
                       struct circle_point half, double edge, struct flux_sum *sum)
{
  const double middle = b->height - 0.5 * frame->time * b->center.y;
  const struct vec3 center = vec3_sub(b->center, vec3_add_scaled(frame->at_zero, middle, frame->rate));
  double r[3], u[3];
  for (int k = 0; k < 3; k++)
    r[k] = value(b->apart[k], half), u[k] = value(b->rate[k], half);
  for (int i = 0; i < 2; i++) {
    const double to = i == 0 ? 0.5 : -0.5, y = middle + to * r[1];
    const double w[3] = {center.x + to * u[0], center.y + to * u[1], center.z + to * u[2]};
    if (!(y >= 1.0 && y < edge - 1.0))
      continue;
    sum->n++;
    sum->wx += flux_fixed(w[0]), sum->wy += flux_fixed(w[1]), sum->wz += flux_fixed(w[2]);
    for (int k = 0; k < STRESS_COMPONENTS; k++)
      sum->product[k] += flux_fixed(w[axes[k][0]] * w[axes[k][1]]);
  }
  const double share = share_in_bulk(middle - 0.5 * fabs(r[1]), fabs(r[1]), edge);
  for (int k = 0; k < STRESS_COMPONENTS; k++)
    sum->spring[k] += flux_fixed(spring * share * r[axes[k][0]] * r[axes[k][1]]);
}

/* ----------------------------------------------------------------------------------------------------------------- */

void dumbbells_flux(const struct state *state, const struct model *model, const struct flux_frame *frame,
                    struct flux_sum *sum)
{
  const double turns_per_radian = 0x1.45f306dc9c883p-3, w = model->dumbbells.frequency;
  const struct mean mean = mean_over(w, frame->time);
  const struct circle_point half = elementary_circle_turns(0.5 * w * frame->time * turns_per_radian);
  for (uint32_t p = 0; p < state->dumbbells.n; p++) {
    const struct swinging b = swinging_at(state, model, frame, p);
    if (model_has_walls(model))
      add_middle(&b, frame, model->dumbbells.spring, half, model->box.cells[1], sum);
    else
      add_mean(&b, frame, model->dumbbells.spring, &mean, sum);
  }
}
