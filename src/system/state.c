#include "system/state.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "base/memory.h"

bool state_alloc(struct state *s, const struct model *model)
{
  memset(s, 0, sizeof *s);
  size_t n = model->solvent.particles ? model->solvent.particles : 1, v = model->vertices ? model->vertices : 1,
         pairs = model->dumbbells.pairs ? model->dumbbells.pairs : 1;
  s->solvent.n = model->solvent.particles;
  s->vertices = model->vertices;
  s->dumbbells.n = model->dumbbells.pairs;
  s->beads = model_has_bead(model);
  s->wall_rows = model_has_walls(model) ? WALLS * ACCOUNT_SHARES : 0;
  int64_t **lattice[] = {&s->solvent.x, &s->solvent.y, &s->solvent.z};
  int64_t **spring[] = {&s->dumbbells.x, &s->dumbbells.y, &s->dumbbells.z};
  double **real[] = {&s->solvent.vx, &s->solvent.vy, &s->solvent.vz};
  bool ok = true;
  for (int k = 0; k < 3; k++) {
    ok &= (*lattice[k] = memory_alloc(n, sizeof **lattice[k])) != NULL;
    ok &= (*real[k] = memory_alloc(n, sizeof **real[k])) != NULL;
    ok &= (*spring[k] = memory_alloc(pairs, sizeof **spring[k])) != NULL;
  }
  ok &= (s->dumbbells.id = memory_alloc(pairs, sizeof *s->dumbbells.id)) != NULL;
  ok &= (s->solvent.id = memory_alloc(n, sizeof *s->solvent.id)) != NULL;
  ok &= (s->position = memory_alloc(v, sizeof *s->position)) != NULL;
  ok &= (s->velocity = memory_alloc(v, sizeof *s->velocity)) != NULL;
  ok &= (s->wall_momentum = memory_alloc(WALLS * ACCOUNT_SHARES, sizeof *s->wall_momentum)) != NULL;
  ok &= (s->bead = memory_alloc(1, sizeof *s->bead)) != NULL;
  if (!ok) {
    state_free(s);
    return false;
  }
  for (uint32_t i = 0; i < s->solvent.n; i++)
    s->solvent.id[i] = i;
  for (uint32_t p = 0; p < s->dumbbells.n; p++)
    s->dumbbells.id[p] = p;
  return true;
}

void state_free(struct state *s)
{
  free(s->solvent.x);
  free(s->solvent.y);
  free(s->solvent.z);
  free(s->solvent.vx);
  free(s->solvent.vy);
  free(s->solvent.vz);
  free(s->solvent.id);
  free(s->dumbbells.x);
  free(s->dumbbells.y);
  free(s->dumbbells.z);
  free(s->dumbbells.id);
  free(s->position);
  free(s->velocity);
  free(s->wall_momentum);
  free(s->bead);
  memset(s, 0, sizeof *s);
}

static uint64_t as_it_is(uint64_t bytes)
{
  return bytes;
}

/* What `of` says of each array, in all. */
static uint64_t over_arrays(const struct model *model, uint64_t (*of)(uint64_t bytes))
{
  const uint64_t particles = model->solvent.particles, pairs = model->dumbbells.pairs, vertices = model->vertices;
  return 6 * of(particles * sizeof(double)) + of(particles * sizeof(uint32_t)) + 3 * of(pairs * sizeof(int64_t)) +
         of(pairs * sizeof(uint32_t)) + of(vertices * sizeof(struct point)) + of(vertices * sizeof(struct vec3));
}

uint64_t state_bytes(const struct model *model)
{
  return over_arrays(model, as_it_is);
}

uint64_t state_memory(const struct model *model)
{
  return over_arrays(model, memory_taken);
}

uint32_t state_lost_vertex(const struct state *s)
{
  uint32_t v = 0;
  while (v < s->vertices && point_within_reach(s->position[v]))
    v++;
  return v;
}

void state_solvent_slots(const struct state *s, uint32_t *slot)
{
  for (uint32_t i = 0; i < s->solvent.n; i++)
    slot[s->solvent.id[i]] = i;
}

/* --- fields ------------------------------------------------------------------------------------------------------ */

const struct state_number state_numbers[] = {
    {"step", 8, true, false, false, offsetof(struct state, step)},
    {"solvent_lag", 4, true, false, false, offsetof(struct state, solvent_lag)},
    {"solvent_time", 8, false, true, false, offsetof(struct state, solvent_time)},
    {"moves", 8, false, false, false, offsetof(struct state, counts.moves)},
    {"possible", 8, false, false, false, offsetof(struct state, counts.possible)},
    {"executed", 8, false, false, false, offsetof(struct state, counts.executed)},
    {"negative", 8, false, false, false, offsetof(struct state, counts.negative)},
    {"softened", 8, false, true, false, offsetof(struct state, counts.softened)},
    {"rigid", 8, false, true, false, offsetof(struct state, counts.rigid)},
    {"wall_turns_0", 8, false, true, true, offsetof(struct state, wall_turns[0])},
    {"wall_turns_1", 8, false, true, true, offsetof(struct state, wall_turns[1])},
    {"wall_turns_2", 8, false, true, true, offsetof(struct state, wall_turns[2])},
    {"wall_turns_3", 8, false, true, true, offsetof(struct state, wall_turns[3])},
};
const size_t state_number_count = sizeof state_numbers / sizeof *state_numbers;

void state_groups(const struct state *s, struct state_group group[STATE_GROUPS])
{
  const struct solvent *p = &s->solvent;
  const struct dumbbells *d = &s->dumbbells;
  struct point *r = s->position;
  struct vec3 *v = s->velocity;
  struct point *w = s->wall_momentum;
  struct bead *b = s->bead;
  const struct state_group groups[STATE_GROUPS] = {
      {p->n,
       false,
       p->id,
       2,
       {{"solvent_position", true, {p->x, p->y, p->z}, sizeof *p->x},
        {"solvent_velocity", false, {p->vx, p->vy, p->vz}, sizeof *p->vx}}},
      {s->vertices,
       false,
       NULL,
       2,
       {{"vertex_position", true, {&r->x, &r->y, &r->z}, sizeof *r},
        {"vertex_velocity", false, {&v->x, &v->y, &v->z}, sizeof *v}}},
      {d->n, true, d->id, 1, {{"dumbbell_vector", true, {d->x, d->y, d->z}, sizeof *d->x}}},
      {s->wall_rows, true, NULL, 1, {{"wall_momentum", true, {&w->x, &w->y, &w->z}, sizeof *w}}},
      {s->beads,
       true,
       NULL,
       3,
       {{"bead_position", true, {&b->position.x, &b->position.y, &b->position.z}, sizeof *b},
        {"bead_velocity", false, {&b->velocity.x, &b->velocity.y, &b->velocity.z}, sizeof *b},
        {"bead_account", true, {&b->account.x, &b->account.y, &b->account.z}, sizeof *b}}},
  };
  memcpy(group, groups, sizeof groups);
}

void state_group_slots(const struct state_group *group, uint32_t *slot)
{
  for (uint32_t i = 0; group->id && i < group->rows; i++)
    slot[group->id[i]] = i;
}

/* Column c of row i of memory. */
static char *place_in(const struct state_field *field, int c, uint32_t i)
{
  return (char *)field->column[c] + i * field->stride;
}

void state_field_get(const struct state_group *group, const struct state_field *field, const uint32_t *slot, void *rows)
{
  char *to = rows;
  for (uint32_t k = 0; k < group->rows; k++)
    for (int c = 0; c < 3; c++, to += 8)
      memcpy(to, place_in(field, c, slot ? slot[k] : k), 8);
}

void state_field_set(const struct state_group *group, const struct state_field *field, const void *rows)
{
  const char *from = rows;
  for (uint32_t k = 0; k < group->rows; k++)
    for (int c = 0; c < 3; c++, from += 8)
      memcpy(place_in(field, c, k), from, 8);
  for (uint32_t k = 0; group->id && k < group->rows; k++)
    group->id[k] = k;
}

/* --- hash -------------------------------------------------------------------------------------------------------- */

enum { HEAD_WORDS = 8 + STATE_GROUPS };

/* Numbers of state and rows of groups, 64 bits each: how many there are. */
static size_t head_words(const struct state *s, const struct state_group *group, uint64_t word[HEAD_WORDS])
{
  size_t n = 0;
  for (size_t k = 0; k < state_number_count; k++) {
    word[n] = 0;
    memcpy(&word[n], (const char *)s + state_numbers[k].offset, state_numbers[k].bytes); /* little-endian */
    n += state_numbers[k].hashed;
  }
  for (int g = 0; g < STATE_GROUPS; g++)
    if (group[g].rows > 0 || !group[g].optional)
      word[n++] = group[g].rows;
  return n;
}

/* Rows in the order of their numbers, the fields of a row one after the other: little-endian on every machine that this
 * project supports. */
static void hash_group(XXH64_state_t *hash, const struct state_group *g, uint32_t *slot)
{
  state_group_slots(g, slot);
  for (uint32_t k = 0; k < g->rows; k++) {
    char row[STATE_FIELDS * 3 * 8], *to = row;
    for (size_t f = 0; f < g->fields; f++)
      for (int c = 0; c < 3; c++, to += 8)
        memcpy(to, place_in(&g->field[f], c, g->id ? slot[k] : k), 8);
    XXH64_update(hash, row, (size_t)(to - row));
  }
}

uint64_t state_hash(const struct state *s)
{
  struct state_group group[STATE_GROUPS];
  uint64_t word[HEAD_WORDS];
  state_groups(s, group);
  XXH64_state_t *hash = XXH64_createState();
  uint32_t most = 0;
  for (int g = 0; g < STATE_GROUPS; g++)
    most = group[g].id && group[g].rows > most ? group[g].rows : most;
  uint32_t *slot = malloc(((size_t)most + 1) * sizeof *slot);
  uint64_t digest = 0;
  if (hash && slot) {
    XXH64_reset(hash, 0);
    XXH64_update(hash, word, head_words(s, group, word) * sizeof *word);
    for (int g = 0; g < STATE_GROUPS; g++)
      hash_group(hash, &group[g], slot);
    digest = XXH64_digest(hash);
  }
  XXH64_freeState(hash);
  free(slot);
  return digest;
}

uint64_t state_digest(const struct state *s)
{
  struct state_group group[STATE_GROUPS];
  uint64_t head[1 + HEAD_WORDS] = {0};
  state_groups(s, group);
  uint64_t digest = XXH64(head, (1 + head_words(s, group, head + 1)) * sizeof *head, 0);
  for (int g = 0; g < STATE_GROUPS; g++)
    for (uint32_t i = 0; i < group[g].rows; i++) {
      uint64_t row[2 + STATE_FIELDS * 3] = {1 + (uint64_t)g, group[g].id ? group[g].id[i] : i}, *to = &row[2];
      for (size_t f = 0; f < group[g].fields; f++)
        for (int c = 0; c < 3; c++)
          memcpy(to++, place_in(&group[g].field[f], c, i), sizeof *to);
      digest += XXH64(row, (size_t)(to - row) * sizeof *row, 0);
    }
  return digest;
}
