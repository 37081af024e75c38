/*
 * The oracle: what other implementations are held against. A pack holds input and output of every operator alone, so
 * that nothing chaotic lies between; a trace holds hashes of the state after every stage of a short run, for ports that
 * promise the same bits. docs/port/contract.md is the contract.
 */
#ifndef UNCROSS_ORACLE_ORACLE_H
#define UNCROSS_ORACLE_ORACLE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/message.h"
#include "oracle/pack.h"
#include "scene/scene.h"
#include "system/state.h"
#include "work.h"

/* Fills a pack with the scene's numbers and every operator's input and output, at the first step that has a collision
 * and at the last one of the scene. The pack needs freeing in any case. */
bool oracle_emit(struct scene *scene, struct pack *pack, struct message *message);

/* Fills `answers` with the outputs of operators of a pack, computed from the inputs that the pack has: of those whose
 * rows stand for themselves; and of those of places, velocities and cells, if its model is fibers and points in a
 * periodic box (head.h). whole: with the inputs, and with all tables of other operators as they are. False, with a
 * message, if an input is missing, or is none that an operator can be asked, or if the model has no such operator. The
 * answers need freeing in any case. The pack's tables are sorted. */
bool oracle_answer(struct pack *pack, bool whole, struct pack *answers, struct message *message);

/* Fills a pack with what a run of the scene starts from: the model, the state, the stages of its steps. */
bool oracle_start(struct scene *scene, struct pack *pack, struct message *message);

/* Writes the trace of the whole scene as CSV: one row per stage of each step. every: only the end of each step whose
 * number is a multiple of it, and of the last one; 0: all. stopped: the physics could not go on; the rows until then
 * are written. */
bool oracle_trace(struct scene *scene, uint64_t every, FILE *out, bool *stopped, struct message *message);

/* Puts a pack's tables in the order of steps, and of operators within a step: files keep them by name. */
void oracle_sort(struct pack *pack);

/* --- comparison -------------------------------------------------------------------------------------------------- */

enum oracle_verdict {
  ORACLE_SAME,   /* every number, to the last bit */
  ORACLE_CLOSE,  /* all differences within the derived tolerances */
  ORACLE_DIFFERS /* some are not, or something is missing */
};

struct oracle_options {
  bool single;       /* tolerances of single-precision arithmetic, else double */
  const char *only;  /* these operators, with commas between; NULL: all */
  const char *namer; /* the program uncross-name, which says what the first difference means; NULL: nobody says it */
  const char *case_file; /* is made, with what uncross-name reads (name.h), and nobody is asked; NULL: none */
  const char *scratch;   /* folder of ours for files that go again; NULL: one is made */
};

enum { ORACLE_TEXT = 640 };

/* What a comparison found. */
struct oracle_summary {
  enum oracle_verdict verdict;
  uint64_t values, different, beyond; /* beyond: tolerance, or something is missing */
  uint64_t unjudged;                  /* whose tolerance is not below the largest size in their table */
  double largest;                     /* of difference over tolerance, where there is a tolerance */
  char first[256];                    /* the first difference; or empty */
  char meaning[ORACLE_TEXT];          /* what it means, as uncross-name says; or empty */
};

/* Puts the columns of `theirs` into the order of ours, by their names. Columns without names (HDF5 without
 * `components`) stay. False, with a message, if a column, or a table of an operator that ours has, is of no known name.
 */
bool oracle_align(const struct pack *ours, struct pack *theirs, struct message *message);

/* Prints how the outputs of `theirs`, aligned, differ from those of `ours`, operator by operator, the first difference,
 * and what it means. False, with a message, if memory is short, `only` names no operator, or the case cannot be
 * written.
 */
bool oracle_compare(const struct pack *ours, const struct pack *theirs, const struct oracle_options *options, FILE *out,
                    struct oracle_summary *summary, struct message *message);

#endif
