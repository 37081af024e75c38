#include "oracle/schema.h"

#include <string.h>

#include "oracle/drift.h"
#include "oracle/rows.h"
#include "oracle/sources.h"
#include "oracle/stages.h"

/* A table that goes in; one that only such scenes have; one that comes out, exact or with a bound; what bounds need. */
#define IN(word, from)                                                                                                 \
  {                                                                                                                    \
    .name = "in." #word, .source = &from_##from                                                                        \
  }
#define IN_OF(scenes, word, from)                                                                                      \
  {                                                                                                                    \
    .name = "in." #word, .source = &from_##from, .of = (scenes)                                                        \
  }
#define EXACT(word, from)                                                                                              \
  {                                                                                                                    \
    .name = "out." #word, .source = &from_##from                                                                       \
  }
#define OUT(word, from, ...)                                                                                           \
  {                                                                                                                    \
    .name = "out." #word, .source = &from_##from, __VA_ARGS__                                                          \
  }
#define BOUND(word, from)                                                                                              \
  {                                                                                                                    \
    .name = "bound." #word, .source = &from_##from                                                                     \
  }

/* Tables that several operators have. */
#define IN_CELLS IN(solvent_cell, particle_cells), IN(vertex_cell, vertex_cells)
#define IN_VELOCITIES IN(solvent, particle_velocities), IN(vertex, velocities)
#define OUT_VELOCITIES(bound) OUT(solvent, particle_velocities, bound), OUT(vertex, velocities, bound)
#define IN_LESS IN(solvent, less_particles), IN(vertex, less_vertices)
#define IN_DRAWN IN(solvent_drawn, drawn_particles), IN(vertex_drawn, drawn_vertices)
#define IN_PLACES IN(solvent_place, particle_places), IN(vertex_place, vertex_places)
#define IN_POSITIONS IN(solvent, particles), IN(vertex, positions)
#define IN_SUMS IN(momentum, momenta), IN(load, loads)
#define IN_VERTICES IN(position, positions), IN(velocity, velocities)
#define IN_PARTICLES IN(position, particles), IN(velocity, particle_velocities)
#define IN_FLIGHT IN(time, flight_time), IN_PARTICLES
#define IN_SLIDE IN(offset, offset), IN(speed, speed)
#define IN_COLLISION IN(shift, shift), IN(offset, offset_of_collision), IN(speed, speed_of_collision), IN_PARTICLES
#define IN_FLIGHTS                                                                                                     \
  IN(p, search_p), IN(q, search_q), IN(w, search_w), IN(p_rate, search_p_rate), IN(q_rate, search_q_rate),             \
      IN(w_rate, search_w_rate), IN(from, search_from)
#define IN_TUBES IN(p, tubes_p), IN(q, tubes_q), IN(w, tubes_w)

#define TUBE_SEARCH IN_FLIGHTS, IN(reach, search_reach), OUT(tick, search_tick, .each = tolerance_tube_tick)
#define TUBE_CONTACT                                                                                                   \
  IN_TUBES, OUT(contact, tubes_contact, .each = tolerance_tube_points),                                                \
      OUT(normal, tubes_normal, .each = tolerance_tube_normal)
#define SWEEP                                                                                                          \
  IN(time, sweep_time), IN(order, order), IN_VERTICES, EXACT(event, sweep_events),                                     \
      OUT(hit, sweep_hits, .each = tolerance_sweep_hit), BOUND(hit, event_condition),                                  \
      OUT(position, positions, .each = tolerance_sweep_position),                                                      \
      OUT(velocity, velocities, .each = tolerance_sweep_velocity)
#define EVENT_DRIFT                                                                                                    \
  IN(time, drift_time), IN_VERTICES, EXACT(event, drift_events), OUT(hit, drift_hits, .each = tolerance_event_hit),    \
      BOUND(hit, event_condition), OUT(position, positions, .each = tolerance_event_position),                         \
      OUT(velocity, velocities, .each = tolerance_event_velocity)
#define IMPULSES                                                                                                       \
  IN(p0, impulse_p0), IN(p1, impulse_p1), IN(q0, impulse_q0), IN(q1, impulse_q1), IN(force_p0, impulse_force_p0),      \
      IN(force_p1, impulse_force_p1), IN(force_q0, impulse_force_q0), IN(force_q1, impulse_force_q1),                  \
      IN(mass, impulse_masses), IN(contact, impulse_contact), IN(normal, impulse_normal), IN(tau, impulse_tau),        \
      OUT(answer, impulse_answer, .each = tolerance_impulse_answer),                                                   \
      OUT(momentum, impulse_momentum, .each = tolerance_impulse_momentum),                                             \
      OUT(p0, after_p0, .each = tolerance_impulse_velocity), OUT(p1, after_p1, .each = tolerance_impulse_velocity),    \
      OUT(q0, after_q0, .each = tolerance_impulse_velocity), OUT(q1, after_q1, .each = tolerance_impulse_velocity)
#define THERMOSTAT(factor_bound)                                                                                       \
  IN_CELLS, IN_VELOCITIES, IN_SUMS, IN(center, centers), OUT(relative, relative, .all = tolerance_relative),           \
      OUT(factor, scales, .each = (factor_bound))
#define DUMBBELLS                                                                                                      \
  IN_FLIGHT, IN(vector, vectors), OUT(position, particles, .all = tolerance_swing_position),                           \
      OUT(velocity, particle_velocities, .all = tolerance_swing_velocity, .later = 1),                                 \
      OUT(vector, vectors, .all = tolerance_swing_position)

const struct oracle_operator oracle_operators[] = {
    {"model", OF_NO_STEP,
     .table = {IN(box, box), IN(numbers, numbers), IN(reals, reals), IN(chain, chain), IN(vertex, kinds),
               IN_OF(OF_THICK, tubes, tubes), IN_OF(OF_FLOW, boundary, boundary), IN_OF(OF_FLOW, flow, flow),
               IN_OF(OF_BETWEEN_WALLS, wall, wall_amplitudes), IN_OF(OF_OSCILLATION, wave, wave),
               IN_OF(OF_DUMBBELLS, dumbbells, dumbbells), IN_OF(OF_DUMBBELLS, spring, spring),
               IN_OF(OF_MEDIUM, medium, medium), IN_OF(OF_MEDIUM, bath, bath)}},
    {"start", OF_NO_STEP,
     .table = {IN(run, run), IN(counters, counters), IN_OF(OF_EVENTS, rule, rule),
               IN_OF(OF_OTHER_RULE, collision, collision), IN(switches, switches), IN(solvent, particles),
               IN(solvent_velocity, particle_velocities), IN_OF(OF_DUMBBELLS, vector, vectors), IN(vertex, positions),
               IN(vertex_velocity, velocities)}},
    {"random", OF_ALL, .begin = oracle_begin_addresses,
     .table = {IN(address, addresses), EXACT(word, words), OUT(uniform, uniforms, .all = tolerance_uniform),
               OUT(normal, normals, .each = tolerance_normal_pair), OUT(axis, random_axes, .each = tolerance_axis)}},
    {"permutation", OF_TURNS, .constructed = true, .run = oracle_run_permutations,
     .table = {IN(address, permutation), EXACT(order, permuted)}},
    {"order", OF_TURNS, .run = oracle_run_order, .table = {EXACT(order, order)}},
    {"crossing", OF_TURNS, .puts_back = true, .begin = oracle_begin_tests, .run = oracle_run_tests,
     .table = {IN(from, test_from), IN(to, test_to), IN(pivot, test_pivot), IN(a, test_a), IN(b, test_b),
               IN(flip, flip), EXACT(crosses, crosses), OUT(hit, hit, .each = tolerance_crossing_hit),
               BOUND(hit, test_condition)}},
    {"meeting", OF_ALL, .constructed = true, .run = oracle_run_meetings,
     .table = {IN(p, meeting_p), IN(q, meeting_q), IN(w, meeting_w), IN(p_last, meeting_p_last),
               IN(q_last, meeting_q_last), IN(w_last, meeting_w_last), EXACT(class, meeting_class),
               EXACT(sign, meeting_signs)}},
    {"exchange", OF_TURNS, .puts_back = true, .begin = oracle_begin_exchanges, .run = oracle_run_exchanges,
     .table = {IN(moving, exchange_moving), IN(pivot, exchange_pivot), IN(a, exchange_a), IN(b, exchange_b),
               IN(mass, exchange_masses), IN(contact, exchange_contact), IN(normal, exchange_normal),
               OUT(momentum, exchange_momentum, .each = tolerance_exchange_momentum),
               OUT(moving, after_moving, .each = tolerance_exchange_velocity),
               OUT(pivot, after_pivot, .each = tolerance_exchange_velocity),
               OUT(a, after_a, .each = tolerance_exchange_velocity),
               OUT(b, after_b, .each = tolerance_exchange_velocity)}},
    {"long_sweep", OF_TURNS, .puts_back = true, .begin = oracle_begin_long_drift, .run = oracle_run_drift,
     .table = {SWEEP}},
    {"sweep", OF_TURNS, .begin = oracle_begin_drift, .run = oracle_run_drift, .table = {SWEEP}},
    {"contact_search", OF_EVENTS, .puts_back = true, .begin = oracle_begin_line_searches, .run = oracle_run_searches,
     .table = {IN_FLIGHTS, EXACT(tick, search_tick)}},
    {"tube_search", OF_TUBES, .puts_back = true, .begin = oracle_begin_tube_searches, .run = oracle_run_searches,
     .table = {TUBE_SEARCH}},
    {"tube_contact", OF_TUBES, .puts_back = true, .begin = oracle_begin_tube_contacts, .run = oracle_run_tubes,
     .table = {TUBE_CONTACT}},
    {"bead_search", OF_COMPANY, .begin = oracle_begin_bead_searches, .run = oracle_run_searches,
     .table = {TUBE_SEARCH}},
    {"bead_contact", OF_COMPANY, .begin = oracle_begin_bead_contacts, .run = oracle_run_tubes, .table = {TUBE_CONTACT}},
    {"impulse", OF_EVENTS, .puts_back = true, .begin = oracle_begin_impulses, .run = oracle_run_impulses,
     .table = {IMPULSES}},
    {"impulse", OF_COMPANY, .begin = oracle_begin_bead_impulses, .run = oracle_run_impulses, .table = {IMPULSES}},
    {"long_event_drift", OF_EVENTS, .puts_back = true, .begin = oracle_begin_long_drift, .run = oracle_run_drift,
     .table = {EVENT_DRIFT}},
    {"event_drift", OF_EVENTS, .begin = oracle_begin_drift, .run = oracle_run_drift, .table = {EVENT_DRIFT}},
    {"bond_force", OF_FIBERS, .run = oracle_run_bond_force,
     .table = {IN(position, positions), OUT(force, forces, .all = tolerance_bond_force)}},
    {"bend_force", OF_FIBERS, .run = oracle_run_bend_force,
     .table = {IN(position, positions), OUT(force, forces, .all = tolerance_bend_force)}},
    {"force", OF_FIBERS, .run = oracle_run_force,
     .table = {IN(position, positions), OUT(force, forces, .all = tolerance_force)}},
    {"mobility", OF_TENSOR, .begin = oracle_begin_entries,
     .table = {IN(position, positions), OUT(tensor, tensor, .all = tolerance_mobility)}},
    {"root", OF_TENSOR, .begin = oracle_begin_entries,
     .table = {IN(tensor, tensor), OUT(root, root, .each = tolerance_root), BOUND(root, root_condition)}},
    {"move", OF_OVERDAMPED, .begin = oracle_begin_entries, .run = oracle_run_move,
     .table = {IN(position, positions), IN(force, forces), IN_OF(OF_TENSOR, tensor, tensor),
               IN_OF(OF_TENSOR, root, root), OUT(position, positions, .all = tolerance_move)}},
    {"kick", OF_MOVING, .run = oracle_run_kick,
     .table = {IN(time, kick_time), IN(velocity, velocities), IN(force, forces),
               OUT(velocity, velocities, .all = tolerance_kick)}},
    {"private_bath", OF_PRIVATE, .run = oracle_run_private_bath,
     .table = {IN(velocity, velocities), OUT(velocity, velocities, .all = tolerance_private_bath)}},
    {"wall_motion", OF_WALLS,
     .table = {IN(interval, intervals), OUT(flight, wall_flights, .all = tolerance_motion),
               OUT(end, wall_ends, .all = tolerance_motion)}},
    {"shear_motion", OF_SHEAR,
     .table = {IN(interval, intervals), IN(half_steps, half_steps), OUT(rate, rates, .all = tolerance_motion),
               EXACT(offset, offsets)}},
    {"dumbbell_start", OF_DUMBBELLS, .begin = oracle_begin_dumbbells,
     .table = {OUT(position, started_particles, .all = tolerance_drawn_place),
               OUT(vector, started_vectors, .all = tolerance_drawn_place)}},
    {"stream", OF_STREAM, .run = oracle_run_stream,
     .table = {IN_FLIGHT, OUT(position, particles, .all = tolerance_stream_position),
               OUT(velocity, particle_velocities, .all = tolerance_stream_velocity)}},
    {"crowd", OF_CROWD, .run = oracle_run_repulsion,
     .table = {IN_POSITIONS, OUT(crowd, crowd, .all = tolerance_crowd)}},
    {"repulsion", OF_REPULSION, .run = oracle_run_repulsion,
     .table = {IN_POSITIONS, IN_OF(OF_CROWD, crowd, crowd), OUT(force, push, .all = tolerance_repulsion)}},
    {"repulsion_kick", OF_REPULSION, .run = oracle_run_repulsion_kick,
     .table = {IN(time, kick_time), IN(force, push), IN_VELOCITIES, OUT_VELOCITIES(.all = tolerance_repulsion_kick)}},
    {"pairs", OF_PAIRS, .run = oracle_run_pairs,
     .table = {IN_POSITIONS, EXACT(pair, pairs), OUT(along, along, .all = tolerance_pair_along),
               OUT(bath, pair_baths, .each = tolerance_pair_draw)}},
    {"pair_bath", OF_PAIRS, .run = oracle_run_pair_bath,
     .table = {IN(pair, pairs), IN(along, along), IN(bath, pair_baths), IN_VELOCITIES,
               OUT_VELOCITIES(.all = tolerance_pair_bath)}},
    {"wall_stream", OF_WALL_POINTS, .run = oracle_run_stream,
     .table = {IN(time, flight_time), IN(wall, walls), IN_PARTICLES,
               OUT(position, particles, .all = tolerance_wall_position),
               OUT(velocity, particle_velocities, .all = tolerance_wall_velocity),
               OUT(given, hits, .all = tolerance_wall_given)}},
    {"shear_stream", OF_SHEAR_POINTS, .run = oracle_run_stream,
     .table = {IN(time, flight_time), IN_SLIDE, IN_PARTICLES, OUT(position, particles, .all = tolerance_wall_position),
               OUT(velocity, particle_velocities, .all = tolerance_slid)}},
    {"dumbbell_stream", OF_PERIODIC_DUMBBELLS, .run = oracle_run_stream, .table = {DUMBBELLS}},
    {"dumbbell_wall_stream", OF_WALL_DUMBBELLS, .run = oracle_run_stream,
     .table = {IN(wall, walls), DUMBBELLS, OUT(given, hits, .all = tolerance_swing_given)}},
    {"dumbbell_shear_stream", OF_SHEAR_DUMBBELLS, .run = oracle_run_stream,
     .table = {IN(begin, offset_before), IN_SLIDE, DUMBBELLS}},
    {"shift", OF_SOLVENT, .table = {EXACT(shift, shift)}},
    {"enter", OF_SHEAR, .begin = oracle_begin_enter, .run = oracle_run_enter,
     .table = {IN_COLLISION, EXACT(position, particles), OUT(velocity, particle_velocities, .all = tolerance_slid)}},
    {"bin", OF_CELLS, .run = oracle_run_bin,
     .table = {IN(shift, shift), IN_POSITIONS, EXACT(solvent, particle_cells), EXACT(vertex, vertex_cells)}},
    {"wall_bin", OF_WALLS, .run = oracle_run_bin,
     .table = {IN(shift, shift), IN(solvent, particles), EXACT(solvent, particle_cells)}},
    {"draw", OF_ANDERSENS, .run = oracle_run_sum,
     .table = {OUT(solvent, drawn_particles, .each = tolerance_drawn),
               OUT(vertex, drawn_vertices, .each = tolerance_drawn)}},
    {"sum", OF_SRD, .run = oracle_run_sum,
     .table = {IN_CELLS, IN_VELOCITIES, OUT(momentum, momenta, .all = tolerance_momentum), EXACT(load, loads)}},
    {"sum", OF_ANDERSENS, .run = oracle_run_sum,
     .table = {IN_CELLS, IN_LESS, OUT(momentum, momenta, .all = tolerance_momentum), EXACT(load, loads)}},
    {"fill", OF_WALLS, .run = oracle_run_fill,
     .table = {IN(shift, shift), IN(wall, walls_at_end), IN_SUMS, OUT(filled, filled, .each = tolerance_filled),
               OUT(momentum, momenta, .each = tolerance_filled_momentum), EXACT(load, loads)}},
    {"solve", OF_SRD, .run = oracle_run_solve,
     .table = {IN_SUMS, EXACT(active, active), OUT(center, centers, .all = tolerance_center),
               OUT(axis, axes, .each = tolerance_axis)}},
    {"mean", OF_ANDERSEN, .run = oracle_run_solve,
     .table = {IN_SUMS, EXACT(active, active), OUT(center, centers, .all = tolerance_center)}},
    {"moments", OF_SPIN,
     .table = {IN_CELLS, IN_PLACES, IN_LESS, IN_SUMS, OUT(beyond, beyond, .each = tolerance_spin_beyond, .later = 3),
               OUT(second, second, .each = tolerance_spin_second),
               OUT(angular, angular, .each = tolerance_spin_angular),
               OUT(middle, middles, .each = tolerance_spin_middle)}},
    {"spin", OF_SPIN, .run = oracle_run_solve,
     .table = {IN_SUMS, IN(beyond, beyond), IN(second, second), IN(angular, angular), EXACT(active, active),
               OUT(center, centers, .all = tolerance_spin_center, .later = 1),
               OUT(omega, axes, .each = tolerance_spin_rate)}},
    {"rescale", OF_HOMOGENEOUS, .run = oracle_run_rescale, .table = {THERMOSTAT(tolerance_rescale)}},
    {"maxwell_boltzmann", OF_HOMOGENEOUS, .run = oracle_run_maxwell_boltzmann,
     .table = {THERMOSTAT(tolerance_boltzmann)}},
    {"rescale_layers", OF_LAYERS, .run = oracle_run_rescale_layers,
     .table = {IN_OF(OF_WALLS, filled, filled), THERMOSTAT(tolerance_rescale)}},
    {"rotate", OF_SRD, .begin = oracle_begin_rotate, .run = oracle_run_rotate,
     .table = {IN(factor, factors), IN_CELLS, IN(active, active), IN(center, centers), IN(axis, axes), IN_VELOCITIES,
               OUT_VELOCITIES(.all = tolerance_rotate)}},
    {"give", OF_ANDERSEN, .run = oracle_run_give,
     .table = {IN_CELLS, IN(active, active), IN(center, centers), IN_DRAWN, IN_VELOCITIES,
               OUT_VELOCITIES(.all = tolerance_give)}},
    {"give_spin", OF_SPIN, .run = oracle_run_give,
     .table = {IN_CELLS, IN_PLACES, IN(active, active), IN(center, centers), IN(omega, axes),
               IN(middle, turned_middles), IN_DRAWN, IN_VELOCITIES, OUT_VELOCITIES(.each = tolerance_give_spin)}},
    {"account", OF_WALLS, .run = oracle_run_account,
     .table = {IN(factor, factors), IN(active, active), IN(center, centers), IN(axis, axes), IN(filled, filled),
               OUT(given, collisions, .all = tolerance_account_given)}},
    {"leave", OF_SHEAR, .run = oracle_run_leave,
     .table = {IN_COLLISION, EXACT(position, particles), OUT(velocity, particle_velocities, .all = tolerance_slid)}},
    {"affine_kick", OF_WAVE, .run = oracle_run_affine_kick,
     .table = {IN(change, change), IN_PARTICLES, OUT(velocity, particle_velocities, .all = tolerance_affine)}},
    {"swap", OF_PERIODIC_POINTS, .run = oracle_run_swap,
     .table = {IN(velocity, particle_velocities), EXACT(order, swaps),
               OUT(velocity, particle_velocities, .all = tolerance_copied_velocity)}},
};
const size_t oracle_operator_count = sizeof oracle_operators / sizeof *oracle_operators;

const struct oracle_table *oracle_table_of(const char *operator_name, const char *name, int *rank)
{
  for (size_t k = 0; k < oracle_operator_count; k++) {
    const struct oracle_operator *o = &oracle_operators[k];
    for (size_t j = 0; strcmp(o->name, operator_name) == 0 && j < ORACLE_TABLES && o->table[j].name; j++)
      if (strcmp(o->table[j].name, name) == 0) {
        if (rank)
          *rank = 2 * ((int)j + o->table[j].later) + (o->table[j].later > 0);
        return &o->table[j];
      }
  }
  return NULL;
}

/* --- as JSON ----------------------------------------------------------------------------------------------------- */

/* Names with blanks between, as a list. */
static void write_words(FILE *out, const char *words)
{
  fputs("[\"", out);
  for (; *words; words++)
    fputs(*words == ' ' ? "\", \"" : (const char[2]){*words, '\0'}, out);
  fputs("\"]", out);
}

static void write_table(FILE *out, const struct oracle_table *t)
{
  const bool comes_out = strncmp(t->name, "out.", strlen("out.")) == 0;
  fprintf(out, "\n    {\"name\": \"%s\", \"type\": \"%s\", \"row\": \"%s\", \"columns\": ", t->name,
          t->source->integers ? "integer" : "real", t->source->of->word);
  write_words(out, t->source->columns);
  if (comes_out)
    fprintf(out, ", \"exact\": %s", t->all || t->each ? "false" : "true");
  if (t->of != OF_ALL)
    fprintf(out, ", \"scenes\": \"%s\"", oracle_scenes_words(t->of));
  fputc('}', out);
}

void oracle_write_schema(FILE *out)
{
  fputs("{\"operators\": [", out);
  for (size_t k = 0; k < oracle_operator_count; k++) {
    const struct oracle_operator *o = &oracle_operators[k];
    fprintf(out, "%s\n  {\"name\": \"%s\", \"scenes\": \"%s\", \"tables\": [", k ? "," : "", o->name,
            oracle_scenes_words(o->of));
    for (size_t j = 0; j < ORACLE_TABLES && o->table[j].name; j++) {
      fputs(j ? "," : "", out);
      write_table(out, &o->table[j]);
    }
    fputs("]}", out);
  }
  fputs("]}\n", out);
}
