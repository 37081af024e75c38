/*
 * The pair list: pairs of bonds (and images of bonds) that are near each other. It is one flat list without order. A
 * drift reads it once, from beginning to end.
 *
 * The generation of a bond is the number of its searches for partners. A pair stores the sum of the generations of its
 * two bonds at the time when it was found. When a bond searches again, its generation grows, and all its older pairs
 * are out of date. The search finds the near bonds anew. An old pair is dropped when it is next read.
 */
#ifndef UNCROSS_CONTACT_PAIRS_H
#define UNCROSS_CONTACT_PAIRS_H

#include "contact/contact.h"

/* Adds a pair that has just been found; it is due when the list is next read. False if memory is short. */
bool pairs_add(struct neighbors *nb, uint32_t bond, struct neighbor n);

/* Drops pair k; the last pair takes its place. */
void pairs_drop(struct neighbors *nb, uint32_t k);

/* True if one of the bonds of pair k has searched for partners since the pair was found. Then either the list has the
 * pair again, or the bonds are apart. */
static inline bool pairs_out_of_date(const struct neighbors *nb, uint32_t k)
{
  const struct pair_list *p = &nb->pairs;
  return p->detail[k].generation != nb->generation[p->bond[k]] + nb->generation[p->other[k]];
}

#endif
