/* What tables of packs are read from: sources.c. */
#ifndef UNCROSS_ORACLE_SOURCES_H
#define UNCROSS_ORACLE_SOURCES_H

#include "oracle/schema.h"

extern const struct oracle_source from_box, from_numbers, from_reals, from_chain, from_kinds, from_tubes, from_boundary,
    from_flow, from_wall_amplitudes, from_wave, from_dumbbells, from_spring, from_medium, from_bath, from_run,
    from_counters, from_rule, from_collision, from_switches;

extern const struct oracle_source from_addresses, from_words, from_uniforms, from_normals, from_random_axes,
    from_permutation, from_permuted;

extern const struct oracle_source from_positions, from_velocities, from_forces, from_order, from_vertex_cells,
    from_drawn_vertices, from_less_vertices, from_vertex_places;

extern const struct oracle_source from_particles, from_particle_velocities, from_particle_cells, from_drawn_particles,
    from_less_particles, from_particle_places, from_swaps, from_vectors, from_started_particles, from_started_vectors;

extern const struct oracle_source from_shift, from_momenta, from_loads, from_active, from_centers, from_axes,
    from_relative, from_factors, from_scales, from_beyond, from_second, from_angular, from_middles, from_turned_middles,
    from_filled;

extern const struct oracle_source from_flight_time, from_kick_time, from_sweep_time, from_drift_time, from_walls,
    from_walls_at_end, from_hits, from_collisions, from_intervals, from_half_steps, from_wall_flights, from_wall_ends,
    from_rates, from_offsets, from_offset, from_speed, from_offset_of_collision, from_speed_of_collision,
    from_offset_before, from_change;

extern const struct oracle_source from_pairs, from_along, from_pair_baths, from_crowd, from_push, from_tensor,
    from_root, from_root_condition;

extern const struct oracle_source from_test_from, from_test_to, from_test_pivot, from_test_a, from_test_b, from_flip,
    from_crosses, from_hit, from_test_condition, from_exchange_moving, from_exchange_pivot, from_exchange_a,
    from_exchange_b, from_exchange_masses, from_exchange_contact, from_exchange_normal, from_exchange_momentum,
    from_after_moving, from_after_pivot, from_after_a, from_after_b;

extern const struct oracle_source from_meeting_p, from_meeting_q, from_meeting_w, from_meeting_p_last,
    from_meeting_q_last, from_meeting_w_last, from_meeting_class, from_meeting_signs;

extern const struct oracle_source from_search_p, from_search_q, from_search_w, from_search_p_rate, from_search_q_rate,
    from_search_w_rate, from_search_from, from_search_reach, from_search_tick, from_tubes_p, from_tubes_q, from_tubes_w,
    from_tubes_contact, from_tubes_normal;

extern const struct oracle_source from_impulse_p0, from_impulse_p1, from_impulse_q0, from_impulse_q1,
    from_impulse_force_p0, from_impulse_force_p1, from_impulse_force_q0, from_impulse_force_q1, from_impulse_masses,
    from_impulse_contact, from_impulse_normal, from_impulse_tau, from_impulse_answer, from_impulse_momentum,
    from_after_p0, from_after_p1, from_after_q0, from_after_q1;

extern const struct oracle_source from_sweep_events, from_sweep_hits, from_drift_events, from_drift_hits,
    from_event_condition;

#endif
