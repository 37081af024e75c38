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

double tolerance_of_vertex(const struct oracle_pair *p, double *(*of)(const struct oracle_pair *), uint32_t vertex,
                           uint32_t most)
{
  struct tolerance_known *known = p->known;
  double *all = known && known->of_vertex ? known->of_vertex : of(p);
  const double found = all && vertex < most ? all[vertex] : 0.0;
  if (known)
    known->of_vertex = all;
  else
    free(all);
  return found;
}

void tolerance_forget(struct tolerance_known *known)
{
  free(known->of_vertex);
  *known = (struct tolerance_known){0};
}
