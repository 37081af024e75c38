/*
 * Collisions around a bead.
 *
 * Flights. The drift has found who meets the bead, and where all of these and the bead go (flight.c; among fibers
 * company.c). Then all particles fly as if there were no bead, and are in the sums of their cells. The few
 * that met it are taken out of the sums, which are integers, get their true places and velocities, and are added again.
 * The largest momentum that the sums have met bounds how far a particle may have come from the bead, and no one may
 * meet two images of it.
 *
 * Virtual particles: matter.c. A drive kicks the bead where it has landed: half of the kick before the collision,
 * half of it after, or all of it after with `order: paper`. What its momentum is taken from: system/bead_drive.c.
 */
#include "bead/collide.h"

#include <string.h>

#include "mpc/cell.h"
#include "mpc/grid.h"
#include "mpc/rule.h"

struct surround bead_surround(const struct bead *bead, const struct model *model, const struct mpc *c, double distance)
{
  const int64_t at[3] = {bead->position.x, bead->position.y, bead->position.z};
  const int64_t shift[3] = {c->shift.x, c->shift.y, c->shift.z};
  struct surround s;
  for (int k = 0; k < 3; k++) {
    const int64_t in_box = k == 1 && model_has_walls(model) ? at[k] : lattice_fold(at[k], model->box.edge[k]);
    s.center[k] = (double)(in_box + shift[k]) * LATTICE_UNIT;
    s.low[k] = (int64_t)floor(s.center[k] - distance);
    s.high[k] = (int64_t)floor(s.center[k] + distance);
  }
  return s;
}

/* --- flights ----------------------------------------------------------------------------------------------------- */

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

/* How far from where the bead was a particle may end that has met it. In the middle of its flight a counterforce has
 * changed its velocity by half as much as at the end. */
static double reach_of(const struct state *state, const struct model *model, double slack, double speed)
{
  const double time = 0.5 * state->solvent_lag * model->time_step;
  const double counter = time * vec3_norm(bead_counter(state, model));
  return model->bead.radius + slack + time * (speed + counter + vec3_norm(state->bead->velocity)) + 1e-3;
}

/* False, with the fault recorded, if an image of the bead may have been met as well. */
static bool one_image(const struct state *state, const struct model *model, double slack, double speed, uint64_t step,
                      struct fault *fault)
{
  const double most = bead_half_edge(model) - 1.0;
  double reach = reach_of(state, model, slack, speed);
  if (!(reach < most))
    reach = reach_of(state, model, slack, fastest_of_all(&state->solvent));
  return reach < most || fault_record(fault, FAULT_BEAD_MOVE, step, 0, reach, most);
}

static bool rebound(const struct bead_flight *all, struct state *state, const struct model *model, struct mpc *c,
                    uint64_t step, uint64_t *span, struct fault *fault)
{
  if (!one_image(state, model, all->slack, fastest(c, *span), step, fault))
    return false;
  for (uint32_t k = 0; k < all->n; k++)
    write_flight(state, model, c, step, &all->at[k], span);
  *state->bead = all->bead;
  for (enum wall wall = 0; model_has_walls(model) && wall < WALLS; wall++) {
    const struct account account = account_of(state, ACCOUNT_HITS);
    account_add_units(&account.sums[wall], &account.turns[wall], all->given[wall]);
  }
  return true;
}

/* --- the drive ---------------------------------------------------------------------------------------------------- */

/* A part of the drive's kick of a step. The solvent has been streamed to now. */
static void drive(struct state *state, const struct model *model, uint64_t now, double part)
{
  if (model->bead.driven && part > 0.0)
    bead_kick(state->bead, model, now, part * model->time_step);
}

/* The part of the kick that comes before the collision. */
static double part_before(const struct model *model)
{
  return model->scheme == SCHEME_PAPER ? 0.0 : 0.5;
}

bool bead_rebound(void *room, struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                  uint64_t *span, struct fault *fault)
{
  const struct bead_work *w = room;
  const struct point from = state->bead->position;
  const uint64_t begin = state->solvent_time, end = begin + state->solvent_lag;
  if (!rebound(&w->flight, state, model, c, step, span, fault))
    return false;
  if (model->bead.driven)
    bead_work(state->bead, model, from, begin, end);
  drive(state, model, end, part_before(model));
  return true;
}

void bead_settle(void *room, struct state *state, const struct model *model, struct mpc *c, uint64_t step)
{
  const struct bead_work *w = room;
  bead_take_gain(&w->cuts, state, model, c, step);
  drive(state, model, state->solvent_time, 1.0 - part_before(model));
}
