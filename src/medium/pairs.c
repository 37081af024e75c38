/*
 * The bath of pairs: Lowe, Europhys. Lett. 47, 145 (1999) and its relatives. The pairs of a step are acted on one after
 * the other, with the velocities that the ones before have left. Their order is random, anew in each step: in an order
 * that follows space, momentum would be carried further along it than against it.
 *
 * For a pair with relative velocity u along the line between them,
 *
 *   v_a += (mu/m_a) e (u' - u),   v_b -= (mu/m_b) e (u' - u),   mu = m_a m_b/(m_a + m_b),
 *
 * which keeps momentum and angular momentum.
 */
#include "medium/medium.h"

/* --- order ----------------------------------------------------------------------------------------------------------
 */

enum { DIGITS = 3, DIGIT_BITS = 11, DIGIT_VALUES = 1 << DIGIT_BITS };

/* Digit d of the upper 32 bits. */
static inline uint32_t digit_of(uint64_t key, int d)
{
  return (uint32_t)(key >> (32 + d * DIGIT_BITS)) & (DIGIT_VALUES - 1);
}

/* Sorts by the upper 32 bits (radix sort, the lowest digit first). */
static void sort_keys(struct medium *m)
{
  uint32_t place[DIGITS][DIGIT_VALUES] = {{0}};
  for (uint32_t k = 0; k < m->encounters; k++)
    for (int d = 0; d < DIGITS; d++)
      place[d][digit_of(m->key[k], d)]++;
  for (int d = 0; d < DIGITS; d++) {
    uint32_t sum = 0;
    for (int v = 0; v < DIGIT_VALUES; v++) {
      const uint32_t here = place[d][v];
      place[d][v] = sum;
      sum += here;
    }
    for (uint32_t k = 0; k < m->encounters; k++)
      m->spare[place[d][digit_of(m->key[k], d)]++] = m->key[k];
    uint64_t *const swap = m->key;
    m->key = m->spare;
    m->spare = swap;
  }
}

/* The two numbers of a pair, the smaller one first, as one. */
static uint64_t numbers_of(const struct medium *m, uint64_t key)
{
  const struct encounter *e = &m->encounter[(uint32_t)key];
  const uint64_t i = m->number[e->a], j = m->number[e->b];
  return i < j ? i << 32 | j : j << 32 | i;
}

/* Among n pairs there are n^2/2^33 of equal order. */
static void settle_ties(struct medium *m)
{
  for (uint32_t k = 1; k < m->encounters; k++)
    for (uint32_t i = k;
         i > 0 && m->key[i] >> 32 == m->key[i - 1] >> 32 && numbers_of(m, m->key[i]) < numbers_of(m, m->key[i - 1]);
         i--) {
      const uint64_t swap = m->key[i];
      m->key[i] = m->key[i - 1];
      m->key[i - 1] = swap;
    }
}

void encounters_order(struct medium *medium)
{
  sort_keys(medium);
  settle_ties(medium);
}

/* --- the bath -------------------------------------------------------------------------------------------------------
 */

void encounter_act(const struct encounter *e, struct mover *mover)
{
  struct mover *a = &mover[e->a], *b = &mover[e->b];
  const double u = vec3_dot(e->along, vec3_sub(a->velocity, b->velocity));
  const double change = bath_change(u, e->loss, e->noise), total = a->mass + b->mass;
  a->velocity = vec3_add_scaled(a->velocity, change * (b->mass / total), e->along);
  b->velocity = vec3_add_scaled(b->velocity, -change * (a->mass / total), e->along);
}

/* In a random order encounters and movers are far apart in memory: both are asked for ahead, the movers when their
 * encounter has come. */
static void act_in_order(const struct medium *m)
{
  enum { SOON = 8, LATER = 24 };
  const uint32_t n = m->encounters;
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t later = k + LATER < n ? k + LATER : n - 1, soon = k + SOON < n ? k + SOON : n - 1;
    const char *far = (const char *)&m->encounter[(uint32_t)m->key[later]];
    const struct encounter *near = &m->encounter[(uint32_t)m->key[soon]];
    __builtin_prefetch(far);
    __builtin_prefetch(far + sizeof(struct encounter) - 1);
    __builtin_prefetch(&m->mover[near->a], 1);
    __builtin_prefetch(&m->mover[near->b], 1);
    encounter_act(&m->encounter[(uint32_t)m->key[k]], m->mover);
  }
}

static void act_on_all(struct state *state, struct medium *medium)
{
  encounters_order(medium);
  act_in_order(medium);
  members_scatter(state, medium);
}

bool pairs_collide(struct state *state, const struct model *model, struct medium *medium, uint64_t step,
                   struct fault *fault)
{
  if (state->solvent_lag > 0 && !medium->fluid->stream(state, model, 0, state->solvent.n, fault))
    return false;
  state_streamed(state);
  members_gather(state, model, medium);
  if (!encounters_find(model, medium, step))
    return fault_no_memory(fault, step);
  act_on_all(state, medium);
  return true;
}

void pairs_act(struct state *state, struct medium *medium)
{
  members_take_velocities(state, medium);
  act_on_all(state, medium);
}
