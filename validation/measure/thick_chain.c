/*
 * Single thick chains in equilibrium, drawn at random and kept if no two of their tubes overlap: exact, without
 * dynamics. What does it matter how many bonds along the chain do not see each other? (docs/thick.md)
 *
 * usage: thick_chain CHAINS DIAMETER BENDING VERTICES BLIND...
 *
 * Bonds of length 0.5 a0 and spring constant 100 (a mean of 0.538). BLIND: bonds of a chain that are fewer bonds apart
 * do not see each other; 0: the program's own rule. For each: the share of draws that were kept; the mean cosine
 * between neighbors, and next neighbors; <R_e^2>. The same chains are drawn for each BLIND, so differences are sharper
 * than errors.
 */
#include "../../tests/statistics.h"
#include "contact/laying.h"
#include "fiber/start.h"
#include "measure.h"

struct chain_means {
  struct sample next, second, span;
  double draws;
};

static double cosine(const struct point *at, uint32_t i, uint32_t j)
{
  const struct vec3 a = point_difference(at[i + 1], at[i]), b = point_difference(at[j + 1], at[j]);
  return vec3_dot(a, b) / vec3_norm(a) / vec3_norm(b);
}

/* Means over one chain are one entry. */
static void add_chain(struct chain_means *c, const struct point *at, uint32_t vertices)
{
  const uint32_t bonds = vertices - 1;
  double next = 0.0, second = 0.0;
  for (uint32_t j = 0; j + 1 < bonds; j++)
    next += cosine(at, j, j + 1) / (bonds - 1);
  for (uint32_t j = 0; j + 2 < bonds; j++)
    second += cosine(at, j, j + 2) / (bonds - 2);
  const struct vec3 r = point_difference(at[bonds], at[0]);
  sample_add(&c->next, next), sample_add(&c->second, second), sample_add(&c->span, vec3_dot(r, r));
}

static bool fits(const struct model *m, const struct point *at)
{
  struct laying l;
  if (!laying_begin(&l, m))
    exit(1);
  const bool ok = laying_add(&l, at, 0) == LAYING_FITS;
  laying_end(&l);
  return ok;
}

int main(int argc, char **argv)
{
  if (argc < 6) {
    fprintf(stderr, "usage: %s CHAINS DIAMETER BENDING VERTICES BLIND...\n", argv[0]);
    return 2;
  }
  const uint64_t chains = strtoull(argv[1], NULL, 10);
  const uint32_t vertices = (uint32_t)atoi(argv[4]);
  int edge = 4;
  while (edge < (int)vertices)
    edge *= 2;
  struct model m = standard_model(edge, edge, edge, 0, 0.01, 1);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  struct fiber_kind *k = add_kind(&m, 1, vertices);
  k->diameter = atof(argv[2]), k->bending = atof(argv[3]);
  struct run run;
  run_start(&run, m, 1);
  const uint32_t own = run.model.kind[0].blind;
  printf("# D %s, bending %s, %s vertices, %llu chains\n# blind  kept      <cos> of neighbors       of next neighbors"
         "        <R_e^2>, a0^2\n",
         argv[2], argv[3], argv[4], (unsigned long long)chains);
  for (int a = 5; a < argc; a++) {
    struct chain_means c = {.draws = 0.0};
    run.model.kind[0].blind = atoi(argv[a]) > 0 ? (uint32_t)atoi(argv[a]) : own;
    for (uint64_t n = 0; n < chains; n++) {
      uint32_t fiber = 0;
      run.model.seed = n + 1;
      if (fiber_start(&run.state, &run.model, NULL, &fiber) != FIBERS_LAID)
        return 1;
      c.draws += 1.0;
      if (fits(&run.model, run.state.position))
        add_chain(&c, run.state.position, vertices);
    }
    printf("%4u%s  %.5f  %9.5f +- %.5f  %9.5f +- %.5f  %9.4f +- %.4f\n", run.model.kind[0].blind,
           run.model.kind[0].blind == own ? " own" : "    ", c.next.n / c.draws, c.next.mean, sample_error(&c.next),
           c.second.mean, sample_error(&c.second), c.span.mean, sample_error(&c.span));
  }
  run_end(&run);
  return 0;
}
