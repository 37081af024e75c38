#include <stdlib.h>

#include "oracle/tolerance.h"

double tolerance_once(const struct oracle_pair *p, double (*of)(const struct oracle_pair *))
{
  struct tolerance_known *known = p->known;
  for (size_t k = 0; known && k < known->sizes; k++)
    if (known->size[k].of == of)
      return known->size[k].is;
  const double is = of(p);
  if (known && known->sizes < TOLERANCE_SIZES)
    known->size[known->sizes++] = (struct tolerance_size){of, is};
  return is;
}

void tolerance_forget(struct tolerance_known *known)
{
  free(known->of_vertex);
  *known = (struct tolerance_known){0};
}
