/*
 * refusal.h for one density and flow as a table for validation/cases: a row for each rule and time step asked for.
 *
 * usage: refused_moves CELLS FIBERS VERTICES FLOW TIME SEED ORDER DT... [-- RULE...]
 *   FLOW a0/t0 along x, TIME t0 per row, ORDER paper, kick-split or drift-split, DT t0; RULE of refusal.h, all if none
 */
#include "refusal.h"

static const char *const orders[] = {
    [SCHEME_PAPER] = "paper", [SCHEME_KICK_SPLIT] = "kick-split", [SCHEME_DRIFT_SPLIT] = "drift-split"};

static const struct refusal_rule *rule_of(const char *name)
{
  for (size_t r = 0; r < sizeof refusal_rules / sizeof *refusal_rules; r++)
    if (strcmp(refusal_rules[r].name, name) == 0)
      return &refusal_rules[r];
  return NULL;
}

static void print_row(const struct refusal_rule *rule, const struct refusal_setup *s)
{
  const struct refusal_cost c = refusal_measure(rule, s);
  printf("%s,%s,%g,%g,%d,%u,%u,%.8g,%.8g,%.8g,%.8g,%.8g,%.8g,%.8g,%.8g,%.0f,%.0f,%.0f,%.3g,%g,%.3f\n", rule->name,
         orders[s->order], s->dt, s->flow, s->cells, s->fibers, s->vertices, c.heat.mean, sample_error(&c.heat),
         c.drift.mean, sample_error(&c.drift), c.lag.mean, sample_error(&c.lag), c.rate.mean, sample_error(&c.rate),
         c.executed, c.possible, c.negative, c.momentum, c.total_time, c.seconds);
  fflush(stdout);
}

int main(int argc, char **argv)
{
  if (argc < 9) {
    fprintf(stderr, "usage: %s CELLS FIBERS VERTICES FLOW TIME SEED ORDER DT... [-- RULE...]\n", argv[0]);
    return 2;
  }
  struct refusal_setup s = {
      .cells = atoi(argv[1]), .fibers = (uint32_t)atoi(argv[2]), .vertices = (uint32_t)atoi(argv[3])};
  s.flow = atof(argv[4]);
  s.time = atof(argv[5]);
  s.seed = strtoull(argv[6], NULL, 10);
  while (s.order <= SCHEME_DRIFT_SPLIT && strcmp(orders[s.order], argv[7]) != 0)
    s.order++;
  int first_rule = 8;
  while (first_rule < argc && strcmp(argv[first_rule], "--") != 0)
    first_rule++;
  printf("rule,order,dt,flow,cells,fibers,vertices,heat,heat_error,drift,drift_error,lag,lag_error,rate,rate_error,"
         "executed,possible,negative,momentum_change,time,seconds\n");
  for (int a = 8; a < first_rule; a++) {
    s.dt = atof(argv[a]);
    for (size_t r = 0; r < sizeof refusal_rules / sizeof *refusal_rules; r++)
      if (first_rule >= argc - 1)
        print_row(&refusal_rules[r], &s);
    for (int b = first_rule + 1; b < argc; b++) {
      const struct refusal_rule *rule = rule_of(argv[b]);
      if (!rule || s.dt <= 0.0 || s.order > SCHEME_DRIFT_SPLIT) {
        fprintf(stderr, "%s: no such rule, time step or order\n", argv[0]);
        return 2;
      }
      print_row(rule, &s);
    }
  }
  return 0;
}
