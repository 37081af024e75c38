/* Drifts of a stage, and their contacts one by one (drift.c). */
#ifndef UNCROSS_ORACLE_DRIFT_H
#define UNCROSS_ORACLE_DRIFT_H

#include "contact/contact.h"
#include "oracle/operators.h"

/* The drift of the step itself; one that is many times as long, or as long as the box allows, and has many contacts:
 * g->drift is set. */
bool oracle_begin_drift(struct oracle_stage *g);
bool oracle_begin_long_drift(struct oracle_stage *g);

/* Such a drift of so many t0, of sweep `number`, from the state as it is. */
bool oracle_begin_drift_of(struct oracle_stage *g, double time, uint32_t number);

/* Makes it; g->row: its contacts, in the order of contracts (struct oracle_event). */
bool oracle_run_drift(struct oracle_stage *g);

/* Rows from the contacts of a long drift. */
bool oracle_begin_tests(struct oracle_stage *g);
bool oracle_begin_exchanges(struct oracle_stage *g);
bool oracle_begin_line_searches(struct oracle_stage *g);
bool oracle_begin_tube_searches(struct oracle_stage *g);
bool oracle_begin_tube_contacts(struct oracle_stage *g);
bool oracle_begin_impulses(struct oracle_stage *g);

/* How far a vertex flies in a tick, as it does now within a drift; and the force on it where it is at a tick, kT/a0. */
struct point oracle_rate_of(const struct oracle_stage *g, uint32_t vertex);
struct vec3 oracle_force_at_tick(const struct oracle_stage *g, uint32_t vertex, int32_t tick);

#endif
