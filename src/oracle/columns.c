#include "oracle/columns.h"

#include <string.h>

#include "mpc/rules/srd.h"

int64_t *oracle_put_integers(struct oracle_stage *g, const char *name, const char *components, uint32_t rows)
{
  return pack_put_integers(g->pack, &g->place, name, components, rows);
}

double *oracle_put_reals(struct oracle_stage *g, const char *name, const char *components, uint32_t rows)
{
  return pack_put_reals(g->pack, &g->place, name, components, rows);
}

void oracle_put_vectors(struct oracle_stage *g, const char *name, const struct vec3 *v, uint32_t rows)
{
  double *to = oracle_put_reals(g, name, "x y z", rows);
  for (uint32_t k = 0; to && k < rows; k++)
    to[3 * k] = v[k].x, to[3 * k + 1] = v[k].y, to[3 * k + 2] = v[k].z;
}

void oracle_put_points(struct oracle_stage *g, const char *name, const struct point *p, uint32_t rows)
{
  int64_t *to = oracle_put_integers(g, name, "x y z", rows);
  for (uint32_t k = 0; to && k < rows; k++)
    to[3 * k] = p[k].x, to[3 * k + 1] = p[k].y, to[3 * k + 2] = p[k].z;
}

void oracle_put_points_of(struct oracle_stage *g, const char *name, const void *first, size_t size, size_t offset,
                          uint32_t rows)
{
  int64_t *to = oracle_put_integers(g, name, "x y z", rows);
  for (uint32_t k = 0; to && k < rows; k++) {
    struct point p;
    memcpy(&p, (const char *)first + k * size + offset, sizeof p);
    to[3 * k] = p.x, to[3 * k + 1] = p.y, to[3 * k + 2] = p.z;
  }
}

void oracle_put_counts(struct oracle_stage *g, const char *name, const char *component, const uint32_t *n,
                       uint32_t rows)
{
  int64_t *to = oracle_put_integers(g, name, component, rows);
  for (uint32_t k = 0; to && k < rows; k++)
    to[k] = n[k];
}

void oracle_put_number(struct oracle_stage *g, const char *name, const char *component, double value)
{
  double *to = oracle_put_reals(g, name, component, 1);
  if (to)
    *to = value;
}

/* Solvent, by id. */
void oracle_put_solvent_positions(struct oracle_stage *g, const char *name)
{
  const struct solvent *s = &g->state->solvent;
  int64_t *to = oracle_put_integers(g, name, "x y z", s->n);
  for (uint32_t id = 0; to && id < s->n; id++) {
    const uint32_t i = g->slot[id];
    to[3 * id] = s->x[i], to[3 * id + 1] = s->y[i], to[3 * id + 2] = s->z[i];
  }
}

void oracle_put_solvent_velocities(struct oracle_stage *g, const char *name)
{
  const struct solvent *s = &g->state->solvent;
  double *to = oracle_put_reals(g, name, "x y z", s->n);
  for (uint32_t id = 0; to && id < s->n; id++) {
    const uint32_t i = g->slot[id];
    to[3 * id] = s->vx[i], to[3 * id + 1] = s->vy[i], to[3 * id + 2] = s->vz[i];
  }
}

void oracle_put_velocities(struct oracle_stage *g, const char *solvent, const char *vertex)
{
  oracle_put_solvent_velocities(g, solvent);
  oracle_put_vectors(g, vertex, g->state->velocity, g->state->vertices);
}

void oracle_put_cells(struct oracle_stage *g, const char *solvent, const char *vertex)
{
  const struct mpc *c = &g->work->mpc;
  int64_t *to = oracle_put_integers(g, solvent, "cell", g->state->solvent.n);
  for (uint32_t id = 0; to && id < g->state->solvent.n; id++)
    to[id] = c->solvent_cell[g->slot[id]];
  oracle_put_counts(g, vertex, "cell", c->vertex_cell, g->state->vertices);
}

uint32_t oracle_cells(const struct oracle_stage *g)
{
  return (uint32_t)box_cell_count(&g->model->box);
}

void oracle_put_sums(struct oracle_stage *g, const char *momentum, const char *load)
{
  const struct cell_sum *sum = g->work->mpc.sum;
  const uint32_t cells = oracle_cells(g);
  int64_t *p = oracle_put_integers(g, momentum, "x y z", cells);
  for (uint32_t k = 0; p && k < cells; k++)
    p[3 * k] = sum[k].px, p[3 * k + 1] = sum[k].py, p[3 * k + 2] = sum[k].pz;
  int64_t *l = oracle_put_integers(g, load, "members mass", cells);
  for (uint32_t k = 0; l && k < cells; k++) {
    l[2 * k] = cell_members(&sum[k]);
    l[2 * k + 1] = (int64_t)(sum[k].load & (CELL_MEMBER - 1));
  }
}

/* Zeros where a cell is left alone. */
void oracle_put_centers(struct oracle_stage *g, const char *name)
{
  double *to = oracle_put_reals(g, name, "x y z", oracle_cells(g));
  for (uint32_t k = 0; to && k < oracle_cells(g); k++) {
    const struct cell_turn *t = &g->work->mpc.turn[k];
    if (t->active != 0.0)
      to[3 * k] = t->center.x, to[3 * k + 1] = t->center.y, to[3 * k + 2] = t->center.z;
  }
}

void oracle_put_axes(struct oracle_stage *g, const char *name)
{
  double *to = oracle_put_reals(g, name, "x y z", oracle_cells(g));
  for (uint32_t k = 0; to && k < oracle_cells(g); k++) {
    const struct cell_turn *t = &g->work->mpc.turn[k];
    if (t->active != 0.0)
      to[3 * k] = t->axis.x, to[3 * k + 1] = t->axis.y, to[3 * k + 2] = t->axis.z;
  }
}

void oracle_put_active(struct oracle_stage *g, const char *name)
{
  int64_t *to = oracle_put_integers(g, name, "active", oracle_cells(g));
  for (uint32_t k = 0; to && k < oracle_cells(g); k++)
    to[k] = g->work->mpc.turn[k].active != 0.0;
}
