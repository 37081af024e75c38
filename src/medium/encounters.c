/* The pairs on which the bath acts in a step: those that are near (near.c) and, where the draw chooses, chosen. */
#include "base/memory.h"
#include "base/normal.h"
#include "medium/near.h"

enum { BLOCK = NEAR_BLOCK };

/* Columns of a block of near pairs, beside their distances. */
struct columns {
  double rate[BLOCK], loss[BLOCK], normal[BLOCK];
  uint64_t word[4][BLOCK];
};

static void draw_words(const struct near_search *s, uint64_t step, const struct near_pairs *p, struct columns *c)
{
  uint32_t low[BLOCK], high[BLOCK];
  for (uint32_t k = 0; k < p->n; k++) {
    const uint32_t i = s->medium->number[p->a[k]], j = s->medium->number[p->b[k]];
    low[k] = i < j ? i : j;
    high[k] = i < j ? j : i;
  }
  random_wide_pair_columns(s->model->seed, RANDOM_BATH_PAIR, step, low, high, p->n, c->word);
}

/* Moves the pairs that are chosen to the front. */
static void choose(struct near_pairs *p, struct columns *c)
{
  uint32_t chosen = 0;
  for (uint32_t k = 0; k < p->n; k++) {
    const uint32_t to = chosen;
    chosen += bath_chooses((uint32_t)c->word[0][k], c->rate[k]);
    p->a[to] = p->a[k];
    p->b[to] = p->b[k];
    p->x[to] = p->x[k];
    p->y[to] = p->y[k];
    p->z[to] = p->z[k];
    p->r[to] = p->r[k];
    for (int i = 1; i < 4; i++)
      c->word[i][to] = c->word[i][k];
  }
  p->n = chosen;
}

static bool make_room(struct medium *m, uint32_t more)
{
  while (m->room - m->encounters < more)
    if (!memory_double((void **)&m->encounter, &m->room, 1024, sizeof *m->encounter) ||
        !memory_grow((void **)&m->key, m->room, sizeof *m->key) ||
        !memory_grow((void **)&m->spare, m->room, sizeof *m->spare))
      return false;
  return true;
}

bool encounters_list(const struct near_search *s, struct near_pairs *p)
{
  const struct encounter_choice *how = s->context;
  struct medium *m = s->medium;
  struct columns c;
  if (!make_room(m, p->n))
    return false;
  how->weigh(p->r, p->n, c.rate);
  for (uint32_t k = 0; k < p->n; k++)
    c.rate[k] *= how->x;
  draw_words(s, how->step, p, &c);
  if (how->draw->chooses)
    choose(p, &c);
  how->draw->lose(c.rate, p->n, c.loss);
  random_normal_third_column(c.word[2], c.word[3], p->n, c.normal);
  for (uint32_t k = 0; k < p->n; k++) {
    const double inverse = 1.0 / p->r[k];
    const double masses = 1.0 / m->mover[p->a[k]].mass + 1.0 / m->mover[p->b[k]].mass;
    m->key[m->encounters] = (uint64_t)(uint32_t)c.word[1][k] << 32 | m->encounters;
    m->encounter[m->encounters++] = (struct encounter){{p->x[k] * inverse, p->y[k] * inverse, p->z[k] * inverse},
                                                       c.loss[k],
                                                       bath_noise(c.loss[k], masses) * c.normal[k],
                                                       p->a[k],
                                                       p->b[k]};
  }
  return true;
}

double encounters_expected(const struct model *m)
{
  const double members = (double)m->solvent.particles + m->vertices, chosen = m->medium.rate * m->time_step;
  if (m->medium.kind != MEDIUM_PAIRS)
    return 0.0;
  const double pairs = members * (members / box_volume(&m->box)) * (2.0 / 3.0 * 3.14159265358979323846);
  return bath_draw_of(m->medium.draw)->chooses && chosen < 1.0 ? chosen * pairs : pairs;
}

struct encounter_choice encounters_begin(const struct model *model, struct medium *medium, uint64_t step)
{
  medium->encounters = 0;
  return (struct encounter_choice){bath_draw_of(model->medium.draw), bath_weight_of(model->medium.weight),
                                   model->medium.rate * model->time_step, step};
}

bool encounters_find(const struct model *model, struct medium *medium, uint64_t step)
{
  struct encounter_choice how = encounters_begin(model, medium, step);
  const struct near_search search = {.model = model, .medium = medium, .look = encounters_list, .context = &how};
  return near_find(&search);
}
