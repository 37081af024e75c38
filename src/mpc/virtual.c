#include "mpc/virtual.h"

#include <string.h>

#include "base/normal.h"
#include "mpc/cell.h"

enum { COLUMN = 64 }; /* cells worked on at a time */

/* e^-mean must not underflow, so a large mean is drawn in equal parts: a sum of Poisson numbers is one. */
#define LARGEST_PART 256.0

/* The last chance is where a further term is lost in the rounding of the sum. */
void virtual_law_of(double mean, struct virtual_law *law)
{
  law->parts = (uint32_t)ceil(mean / LARGEST_PART);
  law->count = 0;
  if (law->parts == 0) /* the mean is 0 */
    return;
  const double each = mean / law->parts;
  double term = elementary_exp(-each), sum = term;
  uint32_t n = 0;
  while (n < VIRTUAL_CHANCES && (n < each || sum + term > sum)) {
    law->at_most[n] = sum;
    term *= each / ++n;
    sum += term;
  }
  law->count = n;
}

/* By inversion, from one uniform deviate: the number of chances that it reaches. All are compared, so that there is no
 * branch to predict. */
static uint32_t number_at(const struct virtual_law *law, double uniform)
{
  uint64_t n = 0;
  for (uint32_t k = 0; k < law->count; k++)
    n += uniform >= law->at_most[k];
  return (uint32_t)n;
}

uint32_t virtual_number(const struct virtual_law *law, const struct model *model, uint64_t step, uint32_t cell)
{
  uint32_t n = 0;
  for (uint32_t part = 0; part < law->parts; part++) {
    const struct random_words r = random_at(model->seed, RANDOM_PHANTOM_NUMBER, part / 2, step, cell);
    n += number_at(law, random_uniform(r, (int)(part % 2)));
  }
  return n;
}

void virtual_numbers(const struct virtual_law *law, const struct model *model, uint64_t step, const uint32_t *cell,
                     uint32_t cells, uint32_t *n)
{
  uint32_t w[4][COLUMN], *column[4] = {w[0], w[1], w[2], w[3]};
  memset(n, 0, cells * sizeof *n);
  for (uint32_t first = 0; first < cells; first += COLUMN) {
    const uint32_t m = cells - first < COLUMN ? cells - first : COLUMN;
    for (uint32_t part = 0; part < law->parts; part++) {
      if (part % 2 == 0)
        random_columns(model->seed, RANDOM_PHANTOM_NUMBER, part / 2, step, &cell[first], m, column);
      for (uint32_t k = 0; k < m; k++) {
        const struct random_words r = {{w[0][k], w[1][k], w[2][k], w[3][k]}};
        n[first + k] += number_at(law, random_uniform(r, (int)(part % 2)));
      }
    }
  }
}

void virtual_normals(const struct model *model, uint64_t step, const uint32_t *cell, uint32_t cells,
                     struct vec3 *normal)
{
  const double depth = model->dimensions == 2 ? 0.0 : 1.0;
  double x[COLUMN], y[COLUMN], z[COLUMN];
  for (uint32_t k = 0; k < cells; k += COLUMN) {
    const uint32_t n = cells - k < COLUMN ? cells - k : COLUMN;
    random_normal_columns(model->seed, RANDOM_PHANTOM_VELOCITY, step, &cell[k], n, x, y, z);
    for (uint32_t i = 0; i < n; i++)
      normal[k + i] = (struct vec3){x[i], y[i], depth * z[i]};
  }
}

bool virtual_room(const struct cell_sum *sum, double n, uint64_t step, uint32_t cell, enum fault_code code,
                  struct fault *fault)
{
  const double most = 0x1p62 * CELL_MOMENTUM_UNIT, heaviest = 0x1p40 * CELL_MASS_UNIT;
  const double momentum[3] = {(double)sum->px, (double)sum->py, (double)sum->pz};
  for (int k = 0; k < 3; k++)
    if (!(fabs(momentum[k]) * CELL_MOMENTUM_UNIT < most))
      return fault_record(fault, code, step, -1, fabs(momentum[k]) * CELL_MOMENTUM_UNIT, most);
  return cell_mass(sum) + n < heaviest ||
         fault_record(fault, FAULT_CELL_MASS, step, cell, cell_mass(sum) + n, heaviest);
}
