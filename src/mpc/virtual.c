#include "mpc/virtual.h"

#include "base/normal.h"
#include "mpc/cell.h"

/* A Poisson number by inversion, from one uniform deviate. Stops at the latest where a further term is lost in the
 * rounding of the sum. */
static uint32_t poisson(double mean, double uniform)
{
  double term = elementary_exp(-mean), sum = term;
  uint32_t n = 0;
  while (uniform >= sum && (n < mean || sum + term > sum)) {
    term *= mean / ++n;
    sum += term;
  }
  return n;
}

/* e^-mean must not underflow, so a large mean is drawn in equal parts: a sum of Poisson numbers is one. */
#define LARGEST_PART 256.0

uint32_t virtual_number(const struct model *model, uint64_t step, uint32_t cell, double mean)
{
  const double parts = ceil(mean / LARGEST_PART), each = mean / parts;
  uint32_t n = 0;
  for (uint32_t part = 0; part < parts; part++)
    n += poisson(each,
                 random_uniform(random_at(model->seed, RANDOM_PHANTOM_NUMBER, part / 2, step, cell), (int)(part % 2)));
  return n;
}

enum { COLUMN = 64 }; /* cells worked on at a time */

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
