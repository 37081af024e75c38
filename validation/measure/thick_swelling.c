/*
 * A single flexible chain of tubes in equilibrium: how far excluded volume swells it (docs/thick.md).
 *
 * usage: thick_swelling SEED EFFORT DIAMETER BONDS [DIAMETER BONDS ...]
 *
 * Bonds of l0 = 0.5, k = 100, no bending. Pivots: all beyond a vertex drawn at random is turned by a rotation drawn at
 * random, and the bond behind that vertex gets a new length. Lengths and rotations are drawn from the equilibrium of
 * the phantom chain, so a trial that the program's own test of starting states passes is kept, and every chain without
 * overlap has the weight of the phantom chain: the equilibrium that contacts leave as it is. EFFORT trials times bonds;
 * one sixth more goes before. Errors are from 32 blocks.
 *
 * z: B2 sqrt(N)/<l^2>^(3/2), B2 that of one bond alone, a spherocylinder. `ideal`: <R^2> without excluded volume.
 */
#include "../../tests/statistics.h"
#include "contact/laying.h"
#include "measure.h"
#include "rods.h"

enum { BLOCKS = 32 };

struct chain {
  struct model model;
  struct point *now, *trial; /* [vertices] */
  uint32_t bonds;
};

/* Edges are powers of two, and leave a swollen chain room without its images: its mean size is N^0.6 l or so. */
static struct model model_of(double diameter, uint32_t bonds)
{
  int edge = 4;
  while (2 * edge < (int)bonds)
    edge *= 2;
  struct model m = standard_model(edge, edge, edge, 0, 0.01, 1);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  struct fiber_kind *k = add_kind(&m, 1, bonds + 1);
  k->bending = 0.0, k->diameter = diameter;
  finish(&m);
  return m;
}

static bool fits(const struct model *m, const struct point *at)
{
  struct laying l;
  if (!laying_begin(&l, m))
    exit(1);
  const enum laying_answer answer = laying_add(&l, at, 0);
  laying_end(&l);
  if (answer == LAYING_NO_MEMORY)
    exit(1);
  return answer == LAYING_FITS;
}

/* A length with the weight l^2 exp(-k (l - l0)^2/2), up to 8 widths from l0, by rejection. */
static double draw_length(struct dice *d, const struct fiber_kind *k)
{
  const double width = 1.0 / sqrt(k->spring), longest = k->bond_length + 8.0 * width;
  for (;;) {
    const double l = k->bond_length + width * dice_normal(d);
    if (l > 0.0 && l < longest && dice_uniform(d) * longest * longest < l * l)
      return l;
  }
}

/* The columns of a rotation, all alike: of a unit quaternion. */
static void draw_rotation(struct dice *d, struct vec3 column[3])
{
  const double a = dice_normal(d), b = dice_normal(d), c = dice_normal(d), e = dice_normal(d),
               s = 2.0 / (a * a + b * b + c * c + e * e);
  column[0] = (struct vec3){1.0 - s * (c * c + e * e), s * (b * c + a * e), s * (b * e - a * c)};
  column[1] = (struct vec3){s * (b * c - a * e), 1.0 - s * (b * b + e * e), s * (c * e + a * b)};
  column[2] = (struct vec3){s * (b * e + a * c), s * (c * e - a * b), 1.0 - s * (b * b + c * c)};
}

static struct vec3 turned(const struct vec3 column[3], struct vec3 v)
{
  return vec3_add_scaled(vec3_add_scaled(vec3_scale(v.x, column[0]), v.y, column[1]), v.z, column[2]);
}

static void try_pivot(struct chain *c, struct dice *d)
{
  const uint32_t at = (uint32_t)dice_integer(d, 0, c->bonds - 1);
  struct vec3 column[3];
  draw_rotation(d, column);
  const struct vec3 bond = point_difference(c->now[at + 1], c->now[at]);
  const struct vec3 stretch =
      vec3_scale(draw_length(d, &c->model.kind[0]) / vec3_norm(bond) - 1.0, turned(column, bond));
  memcpy(c->trial, c->now, (at + 1) * sizeof *c->now);
  for (uint32_t j = at + 1; j <= c->bonds; j++)
    c->trial[j] = point_move(c->now[at], vec3_add(turned(column, point_difference(c->now[j], c->now[at])), stretch));
}

static bool pivot(struct chain *c, struct dice *d)
{
  try_pivot(c, d);
  if (!fits(&c->model, c->trial))
    return false;
  struct point *keep = c->now;
  c->now = c->trial, c->trial = keep;
  return true;
}

/* A zigzag of right angles, along a diagonal of a face: it is shorter than the box. */
static void chain_begin(struct chain *c, double diameter, uint32_t bonds)
{
  c->bonds = bonds, c->model = model_of(diameter, bonds);
  c->now = calloc(bonds + 1, sizeof *c->now), c->trial = calloc(bonds + 1, sizeof *c->trial);
  if (!c->now || !c->trial)
    exit(1);
  for (uint32_t j = 1; j <= bonds; j++)
    c->now[j] = point_move(c->now[j - 1], (struct vec3){0.5 * (j % 2), 0.5 * (j % 2 == 0), 0.0});
  if (!fits(&c->model, c->now)) {
    fprintf(stderr, "a zigzag of %u bonds does not fit\n", bonds);
    exit(1);
  }
}

static void measure_swelling(struct dice *d, double effort, double diameter, uint32_t bonds)
{
  struct chain c;
  chain_begin(&c, diameter, bonds);
  const uint64_t each = 1 + (uint64_t)(effort / bonds / BLOCKS), before = each * BLOCKS / 6;
  for (uint64_t n = 0; n < before; n++)
    pivot(&c, d);
  struct sample size = {0};
  double kept = 0.0;
  for (int b = 0; b < BLOCKS; b++) {
    double sum = 0.0;
    for (uint64_t n = 0; n < each; n++) {
      kept += pivot(&c, d);
      const struct vec3 r = point_difference(c.now[bonds], c.now[0]);
      sum += vec3_dot(r, r);
    }
    sample_add(&size, sum / (double)each);
  }
  const struct fiber_kind *k = &c.model.kind[0];
  const double square = rod_length_moment(k, 2), length = rod_length_moment(k, 1);
  printf("%.9g,%u,%u,%.0f,%.4f,%.6g,%.3g,%.6g,%.6g\n", diameter, bonds, k->blind - 1, (double)each * BLOCKS,
         kept / (double)each / BLOCKS, size.mean, sample_error(&size), bonds * square,
         rod_b2(length, diameter) * sqrt(bonds) / pow(square, 1.5));
  fflush(stdout);
  free(c.now), free(c.trial);
  model_free(&c.model);
}

int main(int argc, char **argv)
{
  if (argc < 5 || argc % 2 == 0) {
    fprintf(stderr, "usage: %s SEED EFFORT DIAMETER BONDS [DIAMETER BONDS ...]\n", argv[0]);
    return 2;
  }
  struct dice d = {strtoull(argv[1], NULL, 10)};
  printf("diameter,bonds,between,trials,kept,R2,R2_error,ideal,z\n");
  for (int a = 3; a + 1 < argc; a += 2)
    measure_swelling(&d, atof(argv[2]), atof(argv[a]), (uint32_t)atoi(argv[a + 1]));
  return 0;
}
