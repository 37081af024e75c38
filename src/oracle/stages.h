/* The functions of operators, and what some of them do before their tables go in (stages.c). Each advances the state.
 * False, with work->fault or pack->failed saying why. */
#ifndef UNCROSS_ORACLE_STAGES_H
#define UNCROSS_ORACLE_STAGES_H

#include "oracle/operators.h"

typedef bool oracle_function(struct oracle_stage *g);

oracle_function oracle_begin_addresses, oracle_run_order;

/* Forces of bonds, of bends, of all. */
oracle_function oracle_run_bond_force, oracle_run_bend_force, oracle_run_force, oracle_run_kick;

oracle_function oracle_run_stream, oracle_run_bin, oracle_run_sum, oracle_run_solve, oracle_run_rescale,
    oracle_run_maxwell_boltzmann, oracle_run_rescale_layers, oracle_begin_rotate, oracle_run_rotate, oracle_run_give,
    oracle_run_swap;

/* Of walls and of shear, of dumbbells. */
oracle_function oracle_run_fill, oracle_run_account, oracle_begin_enter, oracle_run_enter, oracle_run_leave,
    oracle_run_affine_kick, oracle_begin_dumbbells;

/* Of media; begin: rows are the entries of tensors. */
oracle_function oracle_run_private_bath, oracle_run_pairs, oracle_run_pair_bath, oracle_run_repulsion,
    oracle_run_repulsion_kick, oracle_begin_entries, oracle_run_move;

/* Contacts with the bead until now (bead.c). */
oracle_function oracle_begin_bead_searches, oracle_begin_bead_contacts, oracle_begin_bead_impulses;

#endif
