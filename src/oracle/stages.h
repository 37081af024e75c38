/* Each operator of a time step: what goes into it and what comes out is put into the stage's pack, and the stage's
 * state is advanced by it. False, with work->fault or pack->failed saying why. docs/port/contract.md says what is in
 * each table. */
#ifndef UNCROSS_ORACLE_STAGES_H
#define UNCROSS_ORACLE_STAGES_H

#include "oracle/operators.h"

bool oracle_run_order(struct oracle_stage *stage);
bool oracle_run_crossing(struct oracle_stage *stage);
bool oracle_run_exchange(struct oracle_stage *stage);
bool oracle_run_long_sweep(struct oracle_stage *stage);
bool oracle_run_sweep(struct oracle_stage *stage);
bool oracle_run_contact_search(struct oracle_stage *stage);
bool oracle_run_tube_search(struct oracle_stage *stage);
bool oracle_run_tube_contact(struct oracle_stage *stage);
bool oracle_run_impulse(struct oracle_stage *stage);

/* Of fibers around a bead (stages_bead.c). */
bool oracle_run_bead_search(struct oracle_stage *stage);
bool oracle_run_bead_contact(struct oracle_stage *stage);
bool oracle_run_bead_impulse(struct oracle_stage *stage);

bool oracle_run_long_event_drift(struct oracle_stage *stage);
bool oracle_run_event_drift(struct oracle_stage *stage);
bool oracle_run_bond_force(struct oracle_stage *stage);
bool oracle_run_bend_force(struct oracle_stage *stage);
bool oracle_run_force(struct oracle_stage *stage);
bool oracle_run_kick(struct oracle_stage *stage);

bool oracle_run_stream(struct oracle_stage *stage);
bool oracle_run_shift(struct oracle_stage *stage);
bool oracle_run_bin(struct oracle_stage *stage);
bool oracle_run_sum(struct oracle_stage *stage);
bool oracle_run_solve(struct oracle_stage *stage);
bool oracle_run_rescale(struct oracle_stage *stage);
bool oracle_run_maxwell_boltzmann(struct oracle_stage *stage);
bool oracle_run_rotate(struct oracle_stage *stage);
bool oracle_run_swap(struct oracle_stage *stage);

/* Of the rule at-a. */
bool oracle_run_draw(struct oracle_stage *stage);
bool oracle_run_andersen_sum(struct oracle_stage *stage);
bool oracle_run_mean(struct oracle_stage *stage);
bool oracle_run_give(struct oracle_stage *stage);

/* Of the rule at+a, beside `draw` and `sum` of at-a. */
bool oracle_run_moments(struct oracle_stage *stage);
bool oracle_run_spin(struct oracle_stage *stage);
bool oracle_run_give_spin(struct oracle_stage *stage);

/* Of walls and of shear (stages_flow.c). */
bool oracle_run_wall_motion(struct oracle_stage *stage);
bool oracle_run_wall_stream(struct oracle_stage *stage);
bool oracle_run_wall_bin(struct oracle_stage *stage);
bool oracle_run_fill(struct oracle_stage *stage);
bool oracle_run_account(struct oracle_stage *stage);
bool oracle_run_shear_motion(struct oracle_stage *stage);
bool oracle_run_shear_stream(struct oracle_stage *stage);
bool oracle_run_enter(struct oracle_stage *stage);
bool oracle_run_leave(struct oracle_stage *stage);
bool oracle_run_affine_kick(struct oracle_stage *stage);
bool oracle_run_rescale_layers(struct oracle_stage *stage);

/* Of dumbbells (stages_flow.c). */
bool oracle_run_dumbbell_start(struct oracle_stage *stage);
bool oracle_run_dumbbell_stream(struct oracle_stage *stage);
bool oracle_run_dumbbell_wall_stream(struct oracle_stage *stage);
bool oracle_run_dumbbell_shear_stream(struct oracle_stage *stage);

/* Of media (stages_medium.c). */
bool oracle_run_private_bath(struct oracle_stage *stage);
bool oracle_run_crowd(struct oracle_stage *stage);
bool oracle_run_repulsion(struct oracle_stage *stage);
bool oracle_run_repulsion_kick(struct oracle_stage *stage);
bool oracle_run_pairs(struct oracle_stage *stage);
bool oracle_run_pair_bath(struct oracle_stage *stage);
bool oracle_run_mobility(struct oracle_stage *stage);
bool oracle_run_root(struct oracle_stage *stage);
bool oracle_run_move(struct oracle_stage *stage);

/* Tables of the model that only scenes with a medium have. */
void oracle_put_medium(struct oracle_stage *g);

/* A thermostat on the cells as they are; its factors are not used further on. */
bool oracle_run_thermostat(struct oracle_stage *stage, enum thermostat_kind kind);

/* Tables of the model that only scenes with walls or shear have. */
void oracle_put_flow(struct oracle_stage *g);

/* Of the model and of a start, where there are dumbbells. */
void oracle_put_dumbbells(struct oracle_stage *g);
void oracle_put_springs(struct oracle_stage *g, const char *name, const struct state *state);

/* The sweep of this number, for fraction * dt, of the state as it is. */
bool oracle_sweep_for(struct oracle_stage *stage, double fraction, uint32_t sweep);

/* Constructed inputs, where the state of no scene comes near (edges.c, edges_crossing.c): docs/port/packs.md. They
 * change the state. */
bool oracle_edges_permutation(struct oracle_stage *stage);
bool oracle_edges_crossing(struct oracle_stage *stage);
bool oracle_edges_exchange(struct oracle_stage *stage);
bool oracle_edges_sweep(struct oracle_stage *stage);
bool oracle_edges_bin(struct oracle_stage *stage);

/* The same for contacts at their own time (edges_event.c). */
bool oracle_edges_contact_search(struct oracle_stage *stage);
bool oracle_edges_impulse(struct oracle_stage *stage);
bool oracle_edges_event_drift(struct oracle_stage *stage);

#endif
