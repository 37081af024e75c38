#include "base/random.h"

void random_normal_pair(struct random_words r, double out[2])
{
  const double two_pi = 6.283185307179586477;
  double radius = sqrt(-2.0 * log(random_uniform(r, 0)));
  double angle = two_pi * random_uniform(r, 1);
  out[0] = radius * cos(angle);
  out[1] = radius * sin(angle);
}

/* floor(r n / 2^64) */
static uint32_t below(uint64_t r, uint32_t n)
{
  uint64_t high = (r >> 32) * n, low = (r & 0xffffffffu) * n;
  return (uint32_t)((high + (low >> 32)) >> 32);
}

void random_permutation(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, uint32_t n,
                        uint32_t *order)
{
  for (uint32_t k = 0; k < n; k++)
    order[k] = k;
  struct random_words r = {{0}};
  for (uint32_t k = n; k-- > 1;) {
    if (k % 2 == 1 || k == n - 1)
      r = random_at(seed, purpose, draw, step, k / 2);
    uint32_t j = below(random_u64(r, k % 2), k + 1);
    uint32_t swap = order[k];
    order[k] = order[j];
    order[j] = swap;
  }
}
