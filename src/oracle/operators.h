/* The operators of a time step, each alone: what goes in and what comes out is put into a pack. */
#ifndef UNCROSS_ORACLE_OPERATORS_H
#define UNCROSS_ORACLE_OPERATORS_H

#include "oracle/pack.h"
#include "system/model.h"
#include "system/state.h"
#include "wall/motion.h"
#include "work.h"

struct oracle_company;

struct oracle_stage {
  const struct model *model;
  struct state *state; /* advanced by each operator in turn */
  struct work *work;   /* with everything (work_add_everything) */
  struct pack *pack;
  uint64_t steps;                       /* of the scene */
  const struct oracle_company *company; /* contacts of bonds with the bead until now; NULL where nobody asks */

  /* Of the operator at hand. */
  struct pack_place place;
  void *row; /* [rows] what stands for itself (rows.h), allocated */
  uint32_t rows;
  struct oracle_drift {
    double time, start; /* t0; from the middle between two kicks to its beginning */
    uint32_t number;    /* of the sweep within its step */
  } drift;
  struct point account[2 * WALLS]; /* of the walls, before it */
  struct state fresh;              /* a start of its own */
  struct point *position;          /* [vertices] before it, if it puts them back, else NULL */
  struct vec3 *velocity;
};

/* Puts the tables of the model, which all operators share, or those of a start: step 0. */
void oracle_put_model(struct oracle_stage *g);
void oracle_put_start(struct oracle_stage *g);

/* Runs all operators, one after the other, for the step that follows the state's. False, with work->fault or
 * pack->failed saying why. */
bool oracle_run_operators(struct oracle_stage *g);

/* For operators. Appends n rows of this size. False, with pack->failed set, if memory is short. */
bool oracle_add_rows(struct oracle_stage *g, const void *rows, uint32_t n, size_t size);

/* Puts vertices back to where they were before the operator. */
void oracle_put_back(struct oracle_stage *g);

/* True if bonds of this model exchange momentum at the time of contact (rule `event-driven`): its drifts have events,
 * and no order. */
bool oracle_has_events(const struct model *model);

/* Where an operator stands among all of them; 0 for what is none, as `model`. */
int oracle_operator_rank(const char *name);

/* Whether an operator is a whole drift, in which other operators take part. */
bool oracle_is_drift(const char *name);

/* Negative if the data flow through table a before b: by operator, then by table within it, then by step; names
 * decide about what is unknown. */
int oracle_flow(const struct pack_table *a, const struct pack_table *b);

#endif
