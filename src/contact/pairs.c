#include "contact/pairs.h"

#include "base/memory.h"

#define FIRST_PAIRS 4096 /* room at first */

static bool grow_pairs(struct pair_list *p)
{
  const uint32_t room = p->room ? 2 * p->room : FIRST_PAIRS;
  const bool grown = room > p->room && memory_grow((void **)&p->bond, room, sizeof *p->bond) &&
                     memory_grow((void **)&p->other, room, sizeof *p->other) &&
                     memory_grow((void **)&p->limit, room, sizeof *p->limit) &&
                     memory_grow((void **)&p->detail, room, sizeof *p->detail);
  p->room = grown ? room : p->room;
  return grown;
}

bool pairs_add(struct neighbors *nb, uint32_t bond, struct neighbor n)
{
  struct pair_list *p = &nb->pairs;
  if (p->count == p->room && !grow_pairs(p))
    return false;
  const uint32_t k = p->count++;
  p->bond[k] = bond;
  p->other[k] = (uint32_t)n.bond;
  p->limit[k] = nb->path[bond] + nb->path[n.bond] - 1; /* less than the sum of both: due */
  p->detail[k] =
      (struct pair_detail){{{n.image[0], n.image[1], n.image[2]}}, nb->generation[bond] + nb->generation[n.bond]};
  return true;
}

void pairs_drop(struct neighbors *nb, uint32_t k)
{
  struct pair_list *p = &nb->pairs;
  const uint32_t last = --p->count;
  p->bond[k] = p->bond[last];
  p->other[k] = p->other[last];
  p->limit[k] = p->limit[last];
  p->detail[k] = p->detail[last];
}
