/*
 * Thick rods against exact answers (rods.h, docs/thick.md), as tables.
 *
 * usage: thick_rods overlap SEED DRAWS LENGTH DIAMETER [LENGTH DIAMETER ...]
 *        thick_rods flight SEED EDGE COUNT DIAMETER RUNS TIME
 *
 * overlap: pairs of rods are laid at random, DRAWS for each shape, and the program's own test of starting states counts
 * those that overlap. B2 is half of the volume in which they do.
 *
 * flight: RUNS runs of COUNT rods of one bond (1 a0, k 400) in a cube of EDGE a0, without solvent, TIME t0 each.
 * Contacts by the number of ends that take part, all over those of kinetic theory; the same over the rate of lines; the
 * pressure of contacts over that of B2; the energy at the end over that at the start. Errors are from the scatter of
 * the runs.
 */
#include "../../tests/statistics.h"
#include "contact/laying.h"
#include "fiber/force.h"
#include "measure.h"
#include "rods.h"

/* --- pairs laid at random ----------------------------------------------------------------------------------------- */

enum { BOX = 6 }; /* a0: twice the reach of a pair, at least */

static struct model two_rods(double length, double diameter)
{
  struct model m = standard_model(BOX, BOX, BOX, 0, 0.01, 1);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  struct fiber_kind *k = add_kind(&m, 2, 2);
  k->bond_length = length, k->bending = 0.0, k->diameter = diameter;
  finish(&m);
  return m;
}

static bool overlap(const struct model *m, struct dice *d, double length)
{
  struct laying l;
  struct point at[4];
  const int64_t edge = (int64_t)BOX << 40;
  if (!laying_begin(&l, m))
    exit(1);
  for (uint32_t k = 0; k < 2; k++) {
    at[2 * k] = dice_point(d, edge / 2, edge / 2, edge / 2);
    at[2 * k + 1] = point_move(at[2 * k], vec3_scale(length, dice_direction(d)));
  }
  const bool first = laying_add(&l, at, 0) == LAYING_FITS, hit = laying_add(&l, at, 1) == LAYING_OVERLAPS;
  laying_end(&l);
  return first && hit;
}

static void measure_overlap(struct dice *d, int draws, double length, double diameter)
{
  struct model m = two_rods(length, diameter);
  double hits = 0.0;
  for (int n = 0; n < draws; n++)
    hits += overlap(&m, d, length);
  const double share = hits / draws, volume = 0.5 * BOX * BOX * BOX;
  printf("%g,%g,%.6g,%.3g,%.6g\n", length, diameter, volume * share, volume * sqrt(share * (1.0 - share) / draws),
         rod_b2(length, diameter));
  model_free(&m);
}

/* --- rods in flight ----------------------------------------------------------------------------------------------- */

struct answers {
  struct ratio ends[3], all, lines, virial, energy;
};

static double energy_of(const struct run *r)
{
  const struct fiber_energy e = fiber_energies(&r->state, &r->model);
  return 1.5 * r->state.vertices * rod_temperature(&r->state, &r->model) + e.bond + e.bend;
}

static void watch(struct run *r, double time, struct answers *a)
{
  struct fiber_kind *k = &r->model.kind[0], line = *k;
  line.diameter = 0.0;
  const double n = r->model.fibers, volume = box_volume(&r->model.box), length = rod_length_moment(k, 1),
               phi = n * rod_volume(length, k->diameter) / volume, g = rod_contact_value(phi), pairs = n * (n - 1.0);
  const struct rod_rates rates = rod_rates_expected(k), of_lines = rod_rates_expected(&line);
  const uint64_t steps = (uint64_t)(time / r->model.time_step + 0.5);
  struct rod_watch w = {.model = &r->model, .state = &r->state};
  const struct contact_log log = {rod_record, &w};
  double speed = 0.0, heat = 0.0, all = 0.0, wanted = 0.0;
  const double before = energy_of(r);
  for (uint64_t s = 0; s < steps; s++) {
    stop_unless(step_advance(&r->state, &r->model, &r->work, &log), r);
    const double kt = rod_temperature(&r->state, &r->model);
    speed += sqrt(kt) / (double)steps, heat += kt / (double)steps;
  }
  for (int e = 0; e < 3; e++) {
    const double expected = 0.5 * pairs / volume * rates.by_ends[e] * g * speed * time;
    ratio_add(&a->ends[e], w.contacts[e], expected);
    all += w.contacts[e], wanted += expected;
  }
  ratio_add(&a->all, all, wanted);
  ratio_add(&a->lines, all, 0.5 * pairs / volume * of_lines.by_ends[0] * speed * time);
  ratio_add(&a->virial, w.virial / (3.0 * time), pairs / volume * rod_b2(length, k->diameter) * g * heat);
  ratio_add(&a->energy, energy_of(r), before);
}

static void print(const char *name, const struct ratio *r)
{
  printf("%s,%.0f,%.6g,%.3g\n", name, r->x, ratio_value(r), ratio_error(r));
}

static void measure_flight(uint64_t seed, int edge, uint32_t count, double diameter, int runs, double time)
{
  struct answers a = {.all = {0}};
  for (int n = 0; n < runs; n++) {
    struct model m = standard_model(edge, edge, edge, 0, 0.005, 1);
    m.crossing.rule = CROSSING_EVENT_DRIVEN;
    struct fiber_kind *k = add_kind(&m, count, 2);
    k->bond_length = 1.0, k->spring = 400.0, k->bending = 0.0, k->diameter = diameter;
    struct run r;
    run_start(&r, m, seed + (uint64_t)n);
    watch(&r, time, &a);
    run_end(&r);
  }
  printf("what,sum,ratio,ratio_error\n");
  print("all", &a.all);
  print("sides", &a.ends[0]);
  print("edges", &a.ends[1]);
  print("ends", &a.ends[2]);
  print("lines", &a.lines);
  print("pressure", &a.virial);
  print("energy", &a.energy);
}

int main(int argc, char **argv)
{
  const bool overlaps = argc > 5 && strcmp(argv[1], "overlap") == 0,
             flight = argc == 8 && strcmp(argv[1], "flight") == 0;
  if (!flight && !(overlaps && argc % 2 == 0)) {
    fprintf(stderr, "usage: %s overlap SEED DRAWS LENGTH DIAMETER ... | flight SEED EDGE COUNT DIAMETER RUNS TIME\n",
            argv[0]);
    return 2;
  }
  const uint64_t seed = strtoull(argv[2], NULL, 10);
  if (flight) {
    measure_flight(seed, atoi(argv[3]), (uint32_t)atoi(argv[4]), atof(argv[5]), atoi(argv[6]), atof(argv[7]));
    return 0;
  }
  struct dice d = {seed};
  printf("length,diameter,B2,B2_error,exact\n");
  for (int k = 4; k + 1 < argc; k += 2)
    measure_overlap(&d, atoi(argv[3]), atof(argv[k]), atof(argv[k + 1]));
  return 0;
}
