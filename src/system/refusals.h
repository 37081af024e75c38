/*
 * What the keys of a model may not say together: one table, whose rows stand in refusals_list.h. docs/scene.md has
 * it as `uncross schema --document` prints it, and tests/scene/test_refusals.c has a scene for each row. Where a
 * message tells a number, the check stands where this number is made: model_finish.c, medium.c, flow.c, fiber_finish.c,
 * bead.c.
 */
#ifndef UNCROSS_SYSTEM_REFUSALS_H
#define UNCROSS_SYSTEM_REFUSALS_H

#include "system/model.h"

/* Per cell: keeps the momentum of phantoms within a part of its sum's range, see mpc/random_solvent.c. */
enum { MOST_PHANTOMS = 1000 };

/* The moments at which a model is checked. Before each of them, what its rows read has been derived. */
enum refusal_moment {
  AT_MEDIUM,      /* a medium is there */
  AT_MEDIUM_KIND, /* its rate is checked */
  AT_PAIR_FORCES, /* its particles are counted */
  AT_SOLVENT,     /* the collision interval is known */
  AT_DUMBBELLS,
  AT_FLOW,
  AT_WALLS, /* the rate of a strain is derived */
  AT_SHEAR, /* the same */
  AT_BOUNDARY,
  AT_BENDING, /* from here on of each kind of fibers */
  AT_SPRING,  /* bending is derived */
  AT_FROZEN,
  AT_PLACES,
  AT_PLANE,
  AT_TUBE,
  AT_BEAD,        /* a bead is there */
  AT_BEAD_FIBERS, /* of each kind of fibers */
  AT_TRAP,
  AT_END
};

struct refusal {
  enum refusal_moment when;
  const char *key; /* "fibers.mass" of a kind of fibers; "": the whole */
  bool (*is)(const struct model *model, const struct fiber_kind *kind);
  const char *why; /* "what is wrong; allowed ..." */
};

extern const struct refusal refusals[];
extern const size_t refusal_count;

/* Whether no row of this moment refuses the model; else the first that does is in *error. kind: that which is checked,
 * one of the model's; NULL where the moment is not one of a kind. */
bool refusals_check(enum refusal_moment when, const struct model *model, const struct fiber_kind *kind,
                    struct model_error *error);

#endif
