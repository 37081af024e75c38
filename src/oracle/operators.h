/* The operators of a time step, each alone: what goes in and what comes out is put into a pack. */
#ifndef UNCROSS_ORACLE_OPERATORS_H
#define UNCROSS_ORACLE_OPERATORS_H

#include "oracle/pack.h"
#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

struct oracle_stage {
  struct model *model; /* its thermostat is changed by operators, and put back */
  struct state *state; /* advanced by each operator in turn */
  struct work *work;   /* allocated with a thermostat and without hydrodynamics, so that all scratch is there */
  struct pack *pack;
  struct pack_place place;
  uint32_t *slot; /* [particles] of ids in memory */
};

/* Puts the model's numbers, which all operators share: place `model`, step 0. */
void oracle_put_model(struct pack *pack, const struct model *model);

/* Runs all operators, one after the other, for the step that follows the state's. False, with work->fault or
 * pack->failed saying why. */
bool oracle_run_operators(struct oracle_stage *stage);

/* Where an operator stands among all of them; 0 for what is none, as `model`. */
int oracle_operator_rank(const char *name);

#endif
