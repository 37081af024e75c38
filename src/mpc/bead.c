/*
 * Collisions around a bead.
 *
 * Flights. All particles have flown as if there were no bead, and are in the sums of their cells. Who may have met it
 * is known from the cells: a particle that touches the bead in its flight ends within reach of it, and the largest
 * momentum that the sums have met bounds that reach. The few particles that do meet it (fluid/bead.c) are taken out of
 * the sums, which are integers, get their true places and velocities, and are added again.
 *
 * Virtual particles: bead_virtual.c. A drive kicks the bead where it has landed: half of the kick before the collision,
 * half of it after, or all of it after with `order: paper`. What its momentum is taken from: system/bead_drive.c.
 */
#include "mpc/bead.h"

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
    s.center[k] = (double)(lattice_fold(at[k], model->box.edge[k]) + shift[k]) * LATTICE_UNIT;
    s.low[k] = (int64_t)floor(s.center[k] - distance);
    s.high[k] = (int64_t)floor(s.center[k] + distance);
  }
  return s;
}

/* --- flights ----------------------------------------------------------------------------------------------------- */

/* Marks the cells within a distance of the bead, or clears their marks. */
static void mark(const struct surround *s, const struct model *model, struct mpc *c, double distance, uint8_t value)
{
  const double most = distance * distance;
  for (int64_t z = s->low[2]; z <= s->high[2]; z++)
    for (int64_t y = s->low[1]; y <= s->high[1]; y++) {
      const double square = surround_least(s, 2, z) + surround_least(s, 1, y);
      for (int64_t x = s->low[0]; x <= s->high[0]; x++)
        if (square + surround_least(s, 0, x) <= most)
          c->bead.mask[surround_cell(&model->box, x, y, z)] = value;
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
  const uint32_t first = surround_folded(s->low[2], box->cells[2]), n = (uint32_t)(s->high[2] - s->low[2] + 1);
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

/* How far from where the bead was a particle may end that has met it. In the middle of its flight a counterforce has
 * changed its velocity by half as much as at the end. */
static double reach_of(const struct state *state, const struct model *model, double slack, double speed)
{
  const double time = 0.5 * state->solvent_lag * model->time_step;
  const double counter = time * vec3_norm(bead_counter(state, model));
  return model->bead.radius + slack + time * (speed + counter + vec3_norm(state->bead->velocity)) + 1e-3;
}

/* The same; false, with the fault recorded, if an image of the bead may be met as well. */
static bool reach_within(const struct state *state, const struct model *model, double slack, double speed,
                         uint64_t step, double *reach, struct fault *fault)
{
  const double most = 0.5 * box_shortest_edge(&model->box) - 1.0;
  *reach = reach_of(state, model, slack, speed);
  if (!(*reach < most))
    *reach = reach_of(state, model, slack, fastest_of_all(&state->solvent));
  return *reach < most || fault_record(fault, FAULT_BEAD_MOVE, step, 0, *reach, most);
}

/* Who meets the bead if it is off its free flight by `slack` at most. False, with the fault recorded, if an image may
 * be met as well. */
static bool meet(const struct state *state, const struct model *model, struct mpc *c, uint64_t step, double slack,
                 double speed, struct fault *fault)
{
  double reach;
  if (!reach_within(state, model, slack, speed, step, &reach, fault))
    return false;
  const struct surround s = bead_surround(state->bead, model, c, reach);
  mark(&s, model, c, reach, 1);
  const uint32_t near = find_near(state, c, layers_of(&s, &model->box));
  mark(&s, model, c, reach, 0);
  return c->fluid->meet(state, model, c->order, near, slack, &c->bead.meetings, fault);
}

static bool meet_alone(struct state *state, const struct model *model, struct mpc *c, uint64_t step, double speed,
                       struct fault *fault)
{
  double slack = SLACK * 0.5 * state->solvent_lag * model->time_step;
  do {
    if (!meet(state, model, c, step, slack, speed, fault))
      return false;
    slack *= 2.0;
  } while (!c->bead.meetings.enough);
  return true;
}

/* Among fibers the drift has found who meets the bead, and where it goes (contact/event_bead.c). */
static bool rebound(struct state *state, const struct model *model, struct mpc *c, uint64_t step, uint64_t *span,
                    struct fault *fault)
{
  const struct bead_visits *all = &c->bead.meetings;
  const double speed = fastest(c, *span);
  double reach;
  if (state->vertices == 0 && !meet_alone(state, model, c, step, speed, fault))
    return false;
  if (state->vertices > 0 && !reach_within(state, model, all->slack, speed, step, &reach, fault))
    return false;
  for (const struct bead_visit *m = all->at; m < all->at + all->n; m++)
    write_flight(state, model, c, step, m, span);
  *state->bead = all->bead;
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

static bool stream_and_drive(struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                             uint64_t *span, struct fault *fault)
{
  const struct point from = state->bead->position;
  const uint64_t begin = state->solvent_time, end = begin + state->solvent_lag;
  if (!rebound(state, model, c, step, span, fault))
    return false;
  if (model->bead.driven)
    bead_work(state->bead, model, from, begin, end);
  drive(state, model, end, part_before(model));
  return true;
}

static void account(struct state *state, const struct model *model, struct mpc *c, uint64_t step)
{
  bead_take_gain(state, model, c, step);
  drive(state, model, state->solvent_time, 1.0 - part_before(model));
}

const struct border border_bead = {.name = "bead",
                                   .bin_particles = grid_bin_particles,
                                   .bin_vertices = grid_bin_vertices,
                                   .rebound = stream_and_drive,
                                   .fill = bead_fill,
                                   .account = account};
