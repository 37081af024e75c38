/* What tables of packs are read from, a line each. Zeros stand where a cell does not collide. */
#include "oracle/source.h"

#include "contact/rule.h"
#include "mpc/border.h"
#include "mpc/grid.h"
#include "mpc/rules/spin.h"
#include "mpc/rules/srd.h"
#include "oracle/drift.h"
#include "oracle/rows.h"
#include "wall/account.h"

/* --- what rows are ----------------------------------------------------------------------------------------------- */

/* Intervals of which the motion is asked: the first ones, and later ones than 32 bits hold. */
static const uint64_t asked[] = {0, 1, 2, 3, 4, 5, 6, 7, 1000, 4294967295, 4294967296, 1234567890123};

COUNT(rows, g->rows) /* of a tensor */
COUNT(vertices, g->model->vertices)
COUNT(particles, g->state->solvent.n)
COUNT(vectors, g->state->dumbbells.n)
COUNT(started_particles, 2 * g->fresh.dumbbells.n)
COUNT(started_vectors, g->fresh.dumbbells.n)
COUNT(cells, box_cell_count(&g->model->box))
COUNT(cut_cells, 2 * g->model->box.rows[0] * g->model->box.rows[2])
COUNT(walls, WALLS)
COUNT(intervals, sizeof asked / sizeof *asked)
COUNT(half_intervals, 2 * g->model->wave.intervals)
COUNT(members, g->work->medium.members)
COUNT(encounters, g->work->medium.encounters)

NUMBER(particles, g->state->solvent.id[k])
NUMBER(vectors, g->state->dumbbells.id[k])
NUMBER(started_vectors, g->fresh.dumbbells.id[k])
NUMBER(members, g->work->medium.number[k])

static const struct oracle_entity
    once = {.word = "row"},
    vertices = {.word = "vertex", .count = count_vertices},
    particles = {.word = "particle", .count = count_particles, .number = number_particles},
    swaps = {.word = "particle", .count = count_particles},
    vectors = {.word = "dumbbell", .count = count_vectors, .number = number_vectors},
    started_particles = {.word = "particle", .count = count_started_particles},
    started_vectors = {.word = "dumbbell", .count = count_started_vectors, .number = number_started_vectors},
    cells = {.word = "cell", .count = count_cells}, cut_cells = {.word = "cell", .count = count_cut_cells},
    walls = {.word = "wall", .count = count_walls}, intervals = {.word = "interval", .count = count_intervals},
    half_intervals = {.word = "half interval", .count = count_half_intervals},
    members = {.word = "member", .count = count_members, .number = number_members},
    encounters = {.word = "pair", .count = count_encounters}, entries = {.word = "entry", .count = count_rows};

/* --- the model, a start ------------------------------------------------------------------------------------------ */

static const struct fiber_kind *kind_of(const struct model *m, uint32_t vertex)
{
  return &m->kind[m->fiber_kind_of[m->fiber_of[vertex]]];
}

INTEGERS(box, once, "x y z", M->box.cells[0], M->box.cells[1], M->box.cells[2])
INTEGERS(numbers, once, "seed_low seed_high particles interval forbidden exclusion_paper", (uint32_t)M->seed,
         (int64_t)(M->seed >> 32), M->solvent.particles, M->solvent.interval_steps, M->crossing.forbidden,
         M->crossing.exclusion == EXCLUSION_PAPER)
REALS(reals, once, "time_step cosine sine acceleration_x acceleration_y acceleration_z", M->time_step,
      M->solvent.cosine, M->solvent.sine, M->solvent.acceleration.x, M->solvent.acceleration.y,
      M->solvent.acceleration.z)
INTEGERS(chain, vertices, "next prev fiber", M->next[k], M->prev[k], M->fiber_of[k])
REALS(kinds, vertices, "mass bond_length spring bending force_x force_y force_z", M->mass[k],
      kind_of(M, k)->bond_length, kind_of(M, k)->spring, kind_of(M, k)->bending, kind_of(M, k)->force.x,
      kind_of(M, k)->force.y, kind_of(M, k)->force.z)
INTEGERS(tubes, vertices, "radius blind", kind_of(M, k)->radius, kind_of(M, k)->blind)
INTEGERS(boundary, once, "kind slip fill intervals early", M->box.boundary[1], M->walls.kind == WALL_SLIP,
         M->walls.fill, M->wave.intervals, M->scheme == SCHEME_DRIFT_SPLIT)
REALS(flow, once, "per_cell rate", M->solvent.per_cell, M->shear.rate)
VECTOR(wall_amplitudes, walls, k == WALL_LOWER ? M->walls.lower : M->walls.upper)
REALS(wave, half_intervals, "cosine", M->wave.cosine[k])
INTEGERS(dumbbells, once, "number", M->dumbbells.pairs)
REALS(spring, once, "spring frequency depth range", M->dumbbells.spring, M->dumbbells.frequency, M->dumbbells.depth,
      M->dumbbells.range)
INTEGERS(medium, once, "kind draw weight tensor second", M->medium.kind, M->medium.draw, M->medium.weight,
         M->medium.tensor, M->medium.second.share > 0.0 ? M->medium.second.first : M->solvent.particles)
REALS(bath, once, "rate radius repulsion between many_body many_body_range flow_x flow_y flow_z", M->medium.rate,
      M->medium.radius, M->medium.repulsion, M->medium.second.repulsion, M->medium.many.repulsion, M->medium.many.range,
      M->flow.x, M->flow.y, M->flow.z)

enum { START_VERSION = 2 }; /* 1 had no switches */
INTEGERS(run, once, "steps scheme thermostat hydrodynamics", (int64_t)g->steps, M->scheme, M->solvent.thermostat,
         M->solvent.hydrodynamics)
INTEGERS(counters, once, "step lag", (int64_t)g->state->step, g->state->solvent_lag)
INTEGERS(rule, once, "event_driven", 1)
INTEGERS(collision, once, "rule", M->solvent.rule)
INTEGERS(switches, once,
         "version crossing exclusion collision thermostat order swap boundary dumbbells medium repulsion thick",
         START_VERSION,
         !crossing_rule_of(M)->forbids ? 0
         : oracle_has_events(M)        ? 2
                                       : 1,
         crossing_rule_of(M)->forbids && M->crossing.exclusion == EXCLUSION_PAPER, M->solvent.rule,
         M->solvent.thermostat, M->scheme, !M->solvent.hydrodynamics,
         model_has_walls(M)    ? 1
         : model_is_sheared(M) ? 2
                               : 0,
         model_has_dumbbells(M), M->medium.kind, model_repels(M), M->thickness > 0)

/* --- vertices, particles ----------------------------------------------------------------------------------------- */

static struct vec3 drawn(const struct oracle_stage *g, uint32_t k)
{
  double *const *v = g->work->mpc.drawn;
  return (struct vec3){v[0][k], v[1][k], v[2][k]};
}

static struct point place(const struct oracle_stage *g, uint32_t k)
{
  const struct solvent *s = &g->state->solvent;
  return (struct point){s->x[k], s->y[k], s->z[k]};
}

#define MPC g->work->mpc
static bool take_position(struct point *at, const int64_t n[3])
{
  *at = (struct point){n[0], n[1], n[2]};
  return point_within_reach(*at);
}

TAKEN_INTEGERS(positions, vertices, "x y z", take_position(&g->state->position[k], n), g->state->position[k].x,
               g->state->position[k].y, g->state->position[k].z)
TAKEN_VECTOR(velocities, vertices, g->state->velocity[k])
VECTOR(forces, vertices, g->work->fiber.force[k])
TAKEN_INTEGERS(order, vertices, "vertex", n[0] == g->work->contact.order[k], g->work->contact.order[k])
INTEGERS(vertex_cells, vertices, "cell", MPC.vertex_cell[k])
VECTOR(drawn_vertices, vertices, MPC.drawn_vertex[k])
VECTOR(less_vertices, vertices, vec3_sub(g->state->velocity[k], MPC.drawn_vertex[k]))
POINT(vertex_places, vertices, spin_place(g->state->position[k], MPC.shift))

static bool take_place(struct oracle_stage *g, uint32_t k, const int64_t n[3])
{
  const int64_t *edge = g->model->box.edge;
  struct solvent *s = &g->state->solvent;
  s->x[k] = n[0], s->y[k] = n[1], s->z[k] = n[2];
  return n[0] >= 0 && n[0] < edge[0] && n[1] >= 0 && n[1] < edge[1] && n[2] >= 0 && n[2] < edge[2];
}

TAKEN_INTEGERS(particles, particles, "x y z", take_place(g, k, n), place(g, k).x, place(g, k).y, place(g, k).z)
VECTOR(particle_velocities, particles, solvent_velocity(&g->state->solvent, k))
INTEGERS(particle_cells, particles, "cell", MPC.solvent_cell[k])
VECTOR(drawn_particles, particles, drawn(g, k))
VECTOR(less_particles, particles, vec3_sub(solvent_velocity(&g->state->solvent, k), drawn(g, k)))
POINT(particle_places, particles, spin_place(place(g, k), MPC.shift))
INTEGERS(swaps, swaps, "particle", g->state->solvent.id[MPC.order[k]])

POINT(vectors, vectors, {g->state->dumbbells.x[k], g->state->dumbbells.y[k], g->state->dumbbells.z[k]})
POINT(started_particles, started_particles, {g->fresh.solvent.x[k], g->fresh.solvent.y[k], g->fresh.solvent.z[k]})
POINT(started_vectors, started_vectors, {g->fresh.dumbbells.x[k], g->fresh.dumbbells.y[k], g->fresh.dumbbells.z[k]})

/* --- cells ------------------------------------------------------------------------------------------------------- */

static const struct vec3 zero = {0, 0, 0};

static bool is_active(const struct oracle_stage *g, uint32_t k)
{
  return MPC.turn[k].active != 0.0;
}

static struct spin_moments moments(const struct oracle_stage *g, uint32_t k)
{
  struct spin_moments m = {.beyond = {0, 0, 0}};
  struct cell_turn turn = {.active = 0.0};
  cell_solve(&MPC.sum[k], &turn);
  if (turn.active != 0.0)
    spin_moments(&MPC.sum[k], &MPC.spin[k], turn.center, &m);
  return m;
}

static bool is_shift(const struct oracle_stage *g, const int64_t n[3])
{
  const struct point s = grid_shift(M, g->place.step);
  return n[0] == s.x && n[1] == s.y && n[2] == s.z;
}

TAKEN_INTEGERS(shift, once, "x y z", is_shift(g, n), grid_shift(M, g->place.step).x, grid_shift(M, g->place.step).y,
               grid_shift(M, g->place.step).z)
INTEGERS(momenta, cells, "x y z", MPC.sum[k].px, MPC.sum[k].py, MPC.sum[k].pz)
INTEGERS(loads, cells, "members mass", cell_members(&MPC.sum[k]), (int64_t)(MPC.sum[k].load % CELL_MEMBER))
INTEGERS(active, cells, "active", is_active(g, k))
VECTOR(centers, cells, is_active(g, k) ? MPC.turn[k].center : zero)
VECTOR(axes, cells, is_active(g, k) ? MPC.turn[k].axis : zero)
INTEGERS(relative, cells, "energy", is_active(g, k) ? MPC.relative[k] : 0)
REALS(factors, cells, "factor", MPC.turn[k].factor)
REALS(scales, cells, "factor", is_active(g, k) ? MPC.turn[k].factor : 1.0)
VECTOR(beyond, cells, moments(g, k).beyond)
VECTOR(angular, cells, moments(g, k).angular)
POINT(middles, cells, moments(g, k).middle)
POINT(turned_middles, cells, is_active(g, k) ? MPC.middle[k] : (struct point){0, 0, 0})
FILL(second, double, const struct spin_moments m = moments(g, k); memcpy(row, m.second, sizeof m.second);)
const struct oracle_source from_second = {.columns = "xx yy zz yz zx xy", .of = &cells, .reals = fill_second};

/* Velocities of virtual particles where there are none: zeros. */
static struct vec3 filled_velocity(const struct oracle_stage *g, uint32_t k)
{
  return MPC.filled[k].n > 0.0 ? MPC.filled[k].velocity : zero;
}

REALS(filled, cut_cells, "number x y z", MPC.filled[k].n, filled_velocity(g, k).x, filled_velocity(g, k).y,
      filled_velocity(g, k).z)

/* --- times, walls, shear ----------------------------------------------------------------------------------------- */

/* The interval of the flight that comes. */
static uint64_t interval(const struct oracle_stage *g)
{
  return shear_interval(M, g->state->solvent_time);
}

static uint64_t interval_before(const struct oracle_stage *g)
{
  return interval(g) > 0 ? interval(g) - 1 : 0;
}

/* What a share of the account has more than before. */
static struct point given(const struct oracle_stage *g, enum account_share share, uint32_t wall)
{
  const uint32_t k = account_row(share, (enum wall)wall);
  const struct point now = g->state->wall_momentum[k], before = g->account[k];
  return (struct point){now.x - before.x, now.y - before.y, now.z - before.z};
}

#define BOTH_WALLS "lower_x lower_y lower_z upper_x upper_y upper_z"
#define OF_BOTH(velocity)                                                                                              \
  velocity(M, WALL_LOWER, asked[k]).x, velocity(M, WALL_LOWER, asked[k]).y, velocity(M, WALL_LOWER, asked[k]).z,       \
      velocity(M, WALL_UPPER, asked[k]).x, velocity(M, WALL_UPPER, asked[k]).y, velocity(M, WALL_UPPER, asked[k]).z

REALS(flight_time, once, "dt", 0.5 * g->state->solvent_lag * M->time_step)
REALS(kick_time, once, "dt", 0.5 * M->time_step)
/* The long sweep is the second one of its step, with an order of its own. */
static uint32_t number_of_sweep(const struct oracle_stage *g)
{
  return strcmp(g->place.operator_name, "long_sweep") == 0;
}

TAKEN_REALS(sweep_time, once, "dt", oracle_begin_drift_of(g, n[0], number_of_sweep(g)) && n[0] > 0.0, g->drift.time)
TAKEN_REALS(drift_time, once, "dt start", oracle_begin_drift_of(g, n[0], 0) && n[0] > 0.0 && n[1] == g->drift.start,
            g->drift.time, g->drift.start)
VECTOR(walls, walls, shear_wall_velocity(M, (enum wall)k, interval(g)))
VECTOR(walls_at_end, walls, shear_wall_velocity_at_end(M, (enum wall)k, g->place.step / M->solvent.interval_steps - 1))
POINT(hits, walls, given(g, ACCOUNT_HITS, k))
POINT(collisions, walls, given(g, ACCOUNT_COLLISIONS, k))
INTEGERS(intervals, intervals, "interval", (int64_t)asked[k])
INTEGERS(half_steps, intervals, "half_steps", (int64_t)asked[k])
REALS(wall_flights, intervals, BOTH_WALLS, OF_BOTH(shear_wall_velocity))
REALS(wall_ends, intervals, BOTH_WALLS, OF_BOTH(shear_wall_velocity_at_end))
REALS(rates, intervals, "rate", shear_rate(M, asked[k]))
INTEGERS(offsets, intervals, "offset", shear_offset(M, asked[k]))
INTEGERS(offset_before, once, "offset", shear_offset(M, g->state->solvent_time))
INTEGERS(offset, once, "offset", shear_offset(M, g->state->solvent_time + g->state->solvent_lag))
REALS(speed, once, "speed", shear_rate(M, interval(g)) * M->box.cells[1])
INTEGERS(offset_of_collision, once, "offset", shear_offset(M, g->state->solvent_time))
REALS(speed_of_collision, once, "speed", shear_rate(M, interval_before(g)) * M->box.cells[1])
REALS(change, once, "rate", shear_rate(M, interval(g)) - (interval(g) > 0 ? shear_rate(M, interval_before(g)) : 0.0))

/* --- media ------------------------------------------------------------------------------------------------------- */

/* Chosen pairs in the order in which the bath acts on them. */
static const struct encounter *encounter(const struct oracle_stage *g, uint32_t k)
{
  return &g->work->medium.encounter[(uint32_t)g->work->medium.key[k]];
}

static uint32_t number_of(const struct oracle_stage *g, uint32_t k, bool larger)
{
  const uint32_t *number = g->work->medium.number, a = number[encounter(g, k)->a], b = number[encounter(g, k)->b];
  return (a < b) == larger ? b : a;
}

/* The line from the second number to the first, which is the smaller one. */
static struct vec3 along(const struct oracle_stage *g, uint32_t k)
{
  const uint32_t *number = g->work->medium.number;
  const struct encounter *e = encounter(g, k);
  return vec3_scale(number[e->a] < number[e->b] ? 1.0 : -1.0, e->along);
}

INTEGERS(pairs, encounters, "first second", number_of(g, k, false), number_of(g, k, true))
VECTOR(along, encounters, along(g, k))
REALS(pair_baths, encounters, "loss noise", encounter(g, k)->loss, encounter(g, k)->noise)

#define SUMS g->work->medium
INTEGERS(crowd, members, "crowd", SUMS.crowd[k])
INTEGERS(push, members, "x y z", SUMS.push[3 * (size_t)k], SUMS.push[3 * (size_t)k + 1], SUMS.push[3 * (size_t)k + 2])

#define ENTRY ((const struct oracle_entry *)g->row)[k]
REALS(tensor, entries, "entry", ENTRY.tensor)
REALS(root, entries, "entry", ENTRY.root)
REALS(root_condition, entries, "condition", ENTRY.condition)
