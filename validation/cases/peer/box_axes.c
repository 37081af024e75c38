/*
 * Axes of rotation along the box, as in LAMMPS' fix srd: +x, -x, +y, -y, +z, -z, each for one cell in six. Linked into
 * a measuring program in place of random_axes (ld --wrap), it shows what that choice changes and what not.
 */
#include "base/random.h"

void __wrap_random_axes(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity, uint32_t n,
                        struct vec3 *axis);

void __wrap_random_axes(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity, uint32_t n,
                        struct vec3 *axis)
{
  static const struct vec3 of_box[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (uint32_t k = 0; k < n; k++)
    axis[k] = of_box[(uint64_t)random_at(seed, purpose, 0, step, entity[k]).w[0] * 6 >> 32];
}
