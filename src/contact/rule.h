/* A crossing rule: how vertices drift, and what happens where bonds would cross. This is the contract of the rows in
 * rule.c.
 */
#ifndef UNCROSS_CONTACT_RULE_H
#define UNCROSS_CONTACT_RULE_H

#include "contact/contact.h"

struct crossing_rule {
  const char *name;

  /* True: no bond passes through another. A rule without it uses no scratch and records no contacts. */
  bool forbids;

  /* True: vertices move one after the other, in random order. False: all move at once. */
  bool in_turns;

  /* Moves all vertices for the time of contact->frame, in that frame. Every rule guarantees: an
   * exchange conserves momentum to rounding; the bits do not depend on the order of lists; and, if it `forbids`
   * crossing, no bond passes through another. An exchange of a rule in turns conserves kinetic energy to rounding; one
   * of a rule that moves all at once, the energy of the leap-frog to first order in the time step. False, with the
   * fault recorded, as contact_drift. */
  bool (*drift)(struct state *state, const struct model *model, struct contact *contact, uint64_t step, uint32_t drift,
                const struct contact_log *log, struct fault *fault);
};

/* Vertices move freely; bonds may cross. */
extern const struct crossing_rule free_rule;

/* One vertex at a time, in random order (Padding 2009, Sec. III A). */
extern const struct crossing_rule sequential_rule;

/* All vertices at once; contacts at their own time (contact/event_driven.c). */
extern const struct crossing_rule event_driven_rule;

/* The rule of this kind. */
const struct crossing_rule *crossing_rule_row(enum crossing_kind kind);

/* The rule of a model. */
const struct crossing_rule *crossing_rule_of(const struct model *model);

#endif
