/*
 * Heat of a contact of the rule `event-driven`, its balance, and the rate of contacts over kinetic theory (contacts.h).
 * One row per time step, without a thermostat, from the equilibrium of free chains.
 *
 * usage: contact_heat CELLS FIBERS VERTICES KAPPA GAMMA SCHEME TIME RUNS SEED DT...
 *   GAMMA solvent particles per cell (0: none), SCHEME paper, kick-split or drift-split, TIME t0 per row, in PARTS
 * parts: errors are from their scatter. DT t0
 *
 * Columns: heat (mean of Delta H, kT), bilinear (the same mean, with less scatter), balance (<J exp(-Delta H)>), naive
 * (with J = a'/a), half the mean square of Delta H, each with its error; elsewhere: what the energy gained per contact
 * otherwise, and its largest gain between two looks of 0.1 t0 (accidents of the leap-frog); rate over theory with its
 * error, self-contacts left out; shares of softened contacts, of self-contacts, and of contacts of a pair that had one
 * in this step or the one before.
 */
#include "contacts.h"
#include "rules.h"

struct setup {
  int cells;
  uint32_t fibers, vertices;
  double kappa, gamma, time, dt;
  enum scheme scheme;
  int runs;
  uint64_t seed;
};

static struct model model_of(const struct setup *s)
{
  const double every = s->dt > 0.02 ? s->dt : 0.02;
  struct model m = standard_model(s->cells, s->cells, s->cells, s->gamma, s->dt, (uint32_t)(every / s->dt + 0.5));
  m.scheme = s->scheme;
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  add_kind(&m, s->fibers, s->vertices)->bending = s->kappa;
  if (s->vertices == 2)
    m.kind[0].bond_length = 1.0;
  return m;
}

/* Ratios over runs, and sums over all. */
struct result {
  struct ratio heat, bilinear, balance, naive, square, elsewhere, rate;
  struct contact_sums all;
  double jump;
  uint64_t rigid;
};

static void measure_run(const struct setup *s, uint64_t seed, struct result *r)
{
  struct run run;
  struct contact_watch w;
  run_start(&run, model_of(s), seed);
  contact_watch_start(&w, &run);
  const double expected = theory_collision_rate(&run.model) * (1.0 - 1.0 / s->fibers) * s->time;
  const uint64_t settle = (uint64_t)(0.5 / s->dt + 0.5), steps = (uint64_t)(s->time / s->dt + 0.5),
                 look = (uint64_t)(0.1 / s->dt + 0.5);
  run_steps(&run, settle);
  struct energy e = energy_on_step(&run.state, &run.model, &run.work);
  double before = energy_total(&e);
  const double first = before;
  for (uint64_t k = 0; k < steps; k++) {
    contact_step(&run, &w);
    if ((k + 1) % look != 0 && k + 1 != steps)
      continue;
    e = energy_on_step(&run.state, &run.model, &run.work);
    r->jump = fmax(r->jump, fabs(energy_total(&e) - before));
    before = energy_total(&e);
  }
  const struct contact_sums *c = &w.sums;
  ratio_add(&r->heat, c->heat, c->contacts);
  ratio_add(&r->bilinear, c->bilinear, c->contacts);
  ratio_add(&r->balance, c->balance, c->contacts);
  ratio_add(&r->naive, c->naive, c->contacts);
  ratio_add(&r->square, 0.5 * c->square, c->contacts);
  ratio_add(&r->elsewhere, before - first - c->heat, c->contacts);
  ratio_add(&r->rate, c->contacts - c->self, expected);
  r->all.contacts += c->contacts;
  r->all.softened += c->softened;
  r->all.softened_heat += c->softened_heat;
  r->all.self += c->self;
  r->all.again += c->again;
  r->all.largest = fmax(r->all.largest, c->largest);
  r->rigid += run.state.counts.rigid;
  contact_watch_end(&w);
  run_end(&run);
}

static void print_ratio(const struct ratio *r)
{
  printf(",%.8g,%.2g", ratio_value(r), ratio_error(r));
}

static void measure(const struct setup *s)
{
  struct result r = {.jump = 0.0};
  const double start = cpu_seconds();
  for (int n = 0; n < s->runs; n++)
    measure_run(s, s->seed + (uint64_t)n, &r);
  const struct contact_sums *c = &r.all;
  printf("%s,%g,%g,%g,%d,%u,%u,%.0f", scheme_words[s->scheme], s->dt, s->kappa, s->gamma, s->cells, s->fibers,
         s->vertices, c->contacts);
  print_ratio(&r.heat);
  print_ratio(&r.bilinear);
  print_ratio(&r.balance);
  print_ratio(&r.naive);
  print_ratio(&r.square);
  print_ratio(&r.elsewhere);
  print_ratio(&r.rate);
  printf(",%.3g,%.6f,%.3g,%.6f,%.5f,%.3g,%llu,%g,%d,%llu,%.2f\n", r.jump, c->softened / c->contacts,
         c->softened_heat / c->contacts, c->self / c->contacts, c->again / c->contacts, c->largest,
         (unsigned long long)r.rigid, s->time, s->runs, (unsigned long long)s->seed, cpu_seconds() - start);
  fflush(stdout);
}

int main(int argc, char **argv)
{
  if (argc < 11) {
    fprintf(stderr, "usage: %s CELLS FIBERS VERTICES KAPPA GAMMA SCHEME TIME RUNS SEED DT...\n", argv[0]);
    return 2;
  }
  struct setup s = {.cells = atoi(argv[1]),
                    .fibers = (uint32_t)atoi(argv[2]),
                    .vertices = (uint32_t)atoi(argv[3]),
                    .kappa = atof(argv[4]),
                    .gamma = atof(argv[5]),
                    .time = atof(argv[7]),
                    .runs = atoi(argv[8]),
                    .seed = strtoull(argv[9], NULL, 10)};
  s.scheme = scheme_of_word(argv[6]);
  if (s.runs < 2)
    return 2;
  puts("scheme,dt,kappa,gamma,cells,fibers,vertices,contacts,heat,heat_error,bilinear,bilinear_error,balance,"
       "balance_error,naive,naive_error,half_square,half_square_error,elsewhere,elsewhere_error,rate,rate_error,"
       "largest_jump,softened,softened_heat,self,again,largest_heat,rigid,time,runs,seed,seconds");
  for (int a = 10; a < argc; a++) {
    s.dt = atof(argv[a]);
    measure(&s);
  }
  return 0;
}
