/* The operators of a time step, each alone: what goes in and what comes out is put into a pack. */
#ifndef UNCROSS_ORACLE_OPERATORS_H
#define UNCROSS_ORACLE_OPERATORS_H

#include "oracle/pack.h"
#include "system/model.h"
#include "system/state.h"
#include "work.h"

struct oracle_company;

struct oracle_stage {
  const struct model *model;
  struct state *state; /* advanced by each operator in turn */
  struct work *work;   /* with everything (work_add_everything) */
  struct pack *pack;
  struct pack_place place;
  uint32_t *slot;                       /* [particles] of ids in memory */
  const struct oracle_company *company; /* contacts of bonds with the bead until now; NULL where nobody asks */
};

/* Puts the model's numbers, which all operators share: place `model`, step 0. */
void oracle_put_model(struct pack *pack, const struct model *model);

/* Runs all operators, one after the other, for the step that follows the state's; edges: those with constructed inputs,
 * on these. False, with work->fault or pack->failed saying why. */
bool oracle_run_operators(struct oracle_stage *stage, bool edges);

/* True if bonds of this model exchange momentum at the time of contact (rule `event-driven`): its drifts have events,
 * and no order. */
bool oracle_has_events(const struct model *model);

/* Where an operator stands among all of them; 0 for what is none, as `model`. */
int oracle_operator_rank(const char *name);

/* Negative if the data flow through table a before b: by operator, then by table within it, then by step. */
int oracle_flow(const struct pack_table *a, const struct pack_table *b);

#endif
