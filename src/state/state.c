#include "state/state.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "base/memory.h"

bool state_alloc(struct state *s, const struct model *model)
{
  memset(s, 0, sizeof *s);
  size_t n = model->solvent.particles ? model->solvent.particles : 1, v = model->vertices ? model->vertices : 1;
  s->solvent.n = model->solvent.particles;
  s->vertices = model->vertices;
  int64_t **lattice[] = {&s->solvent.x, &s->solvent.y, &s->solvent.z};
  double **real[] = {&s->solvent.vx, &s->solvent.vy, &s->solvent.vz};
  bool ok = true;
  for (int k = 0; k < 3; k++) {
    ok &= (*lattice[k] = memory_alloc(n, sizeof **lattice[k])) != NULL;
    ok &= (*real[k] = memory_alloc(n, sizeof **real[k])) != NULL;
  }
  ok &= (s->solvent.id = memory_alloc(n, sizeof *s->solvent.id)) != NULL;
  ok &= (s->position = memory_alloc(v, sizeof *s->position)) != NULL;
  ok &= (s->velocity = memory_alloc(v, sizeof *s->velocity)) != NULL;
  if (!ok) {
    state_free(s);
    return false;
  }
  for (uint32_t i = 0; i < s->solvent.n; i++)
    s->solvent.id[i] = i;
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
  free(s->position);
  free(s->velocity);
  memset(s, 0, sizeof *s);
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

/* One particle or vertex as it is hashed: 48 bytes, little-endian on every machine that this project supports. */
struct hashed {
  int64_t position[3];
  double velocity[3];
};

uint64_t state_hash(const struct state *s)
{
  const struct solvent *p = &s->solvent;
  XXH64_state_t *hash = XXH64_createState();
  uint32_t *slot = malloc(((size_t)p->n + 1) * sizeof *slot);
  if (!hash || !slot) {
    free(slot);
    XXH64_freeState(hash);
    return 0;
  }
  state_solvent_slots(s, slot);
  uint64_t head[4] = {s->step, s->solvent_lag, p->n, s->vertices};
  XXH64_reset(hash, 0);
  XXH64_update(hash, head, sizeof head);
  for (uint32_t id = 0; id < p->n; id++) {
    uint32_t i = slot[id];
    struct hashed h = {{p->x[i], p->y[i], p->z[i]}, {p->vx[i], p->vy[i], p->vz[i]}};
    XXH64_update(hash, &h, sizeof h);
  }
  for (uint32_t v = 0; v < s->vertices; v++) {
    struct hashed h = {{s->position[v].x, s->position[v].y, s->position[v].z},
                       {s->velocity[v].x, s->velocity[v].y, s->velocity[v].z}};
    XXH64_update(hash, &h, sizeof h);
  }
  uint64_t digest = XXH64_digest(hash);
  XXH64_freeState(hash);
  free(slot);
  return digest;
}

struct vec3 state_solvent_gain(const struct state *s, const struct model *model)
{
  return vec3_scale(0.5 * s->solvent_lag * model->time_step, model->solvent.acceleration);
}

struct vec3 state_solvent_velocity(const struct state *s, const struct model *model, uint32_t i)
{
  return vec3_add(solvent_velocity(&s->solvent, i), state_solvent_gain(s, model));
}

struct point state_solvent_position(const struct state *s, const struct model *model, uint32_t i)
{
  const struct solvent *p = &s->solvent;
  double t = 0.5 * s->solvent_lag * model->time_step;
  struct vec3 a = model->solvent.acceleration;
  int64_t x = p->x[i] + state_flight(p->vx[i], a.x, t);
  int64_t y = p->y[i] + state_flight(p->vy[i], a.y, t);
  int64_t z = p->z[i] + state_flight(p->vz[i], a.z, t);
  const int64_t *edge = model->box.edge;
  return (struct point){lattice_fold(x, edge[0]), lattice_fold(y, edge[1]), lattice_fold(z, edge[2])};
}
