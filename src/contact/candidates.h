/*
 * Candidate contacts: the pairs of bonds that may touch in this drift.
 *
 * Few pairs of the pair list (contact/neighbors.h) can touch in one time step. Each bond has a path: the sum over all
 * drifts of the distance that its ends may have gone. When the distance of a pair is measured, the pair gets a limit:
 * the two bonds cannot touch before the sum of their paths exceeds it. While the sum is smaller, the pair is skipped.
 * When it is larger, the pair is measured again; if both bonds together may go that distance in this drift, the pair is
 * a candidate contact. A drift tests candidates only, and those that later searches add (contact/schedule.h).
 */
#ifndef UNCROSS_CONTACT_CANDIDATES_H
#define UNCROSS_CONTACT_CANDIDATES_H

#include "contact/capsule.h"
#include "contact/contact.h"

#define CANDIDATES_UNITS 20 /* paths and ranges are in units of 2^-20 a0 */

/* A distance below 2000 a0 in these units, rounded up. */
static inline uint32_t candidates_units(double distance)
{
  return (uint32_t)(int32_t)(distance * (1 << CANDIDATES_UNITS)) + 1;
}

/* Adds to all paths the distance that the bonds' ends may go in this drift (contact->range). Once in a drift, before
 * candidates_find. */
void candidates_lengthen(const struct model *model, struct contact *contact);

/* Fills contact->candidates: all pairs that may touch in this drift. False, with the fault recorded, if memory is
 * short. */
bool candidates_find(const struct state *state, const struct model *model, struct contact *contact,
                     struct fault *fault);

/* Makes a candidate contact of bond `bond` and the image of another one, if they are not one yet; each of the two gets
 * an entry. False as candidates_find.
 */
bool candidates_add(const struct state *state, struct contact *contact, uint32_t bond, const struct neighbor *n,
                    struct fault *fault);

/* Raises the range of vertex i to `range`, and the paths of its bonds accordingly. */
void candidates_widen(const struct model *model, struct contact *contact, uint32_t i, uint32_t range);

/* By how much the path of bond j has grown in this drift. */
uint32_t candidates_way(const struct model *model, const struct contact *contact, uint32_t j);

/* Bound on the distance that the ends of a bond go in this drift, a0. */
static inline double candidates_range(const struct model *model, const struct contact *contact, uint32_t bond)
{
  const uint32_t mine = contact->range[bond], its = contact->range[model->next[bond]];
  return (double)(mine > its ? mine : its) / (1 << CANDIDATES_UNITS);
}

#endif
