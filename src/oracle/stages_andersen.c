/* The operators of a collision by the rule at-a, each alone: docs/porting.md, *The rule at-a*. `sum` is in
 * stages_solvent.c: here its velocities are those less the drawn ones. */
#include "mpc/collide.h"
#include "oracle/columns.h"
#include "oracle/stages.h"

/* Velocities of the solvent by id, from columns in memory order. */
static void put_solvent(struct oracle_stage *g, const char *name, double *const drawn[3], double sign, bool less)
{
  const struct solvent *s = &g->state->solvent;
  double *to = oracle_put_reals(g, name, "x y z", s->n);
  for (uint32_t id = 0; to && id < s->n; id++) {
    const uint32_t i = g->slot[id];
    const struct vec3 v = less ? solvent_velocity(s, i) : (struct vec3){0, 0, 0};
    to[3 * id] = v.x + sign * drawn[0][i];
    to[3 * id + 1] = v.y + sign * drawn[1][i];
    to[3 * id + 2] = v.z + sign * drawn[2][i];
  }
}

static void put_vertices(struct oracle_stage *g, const char *name, const struct vec3 *drawn, bool less)
{
  const uint32_t n = g->state->vertices;
  double *to = oracle_put_reals(g, name, "x y z", n);
  for (uint32_t v = 0; to && v < n; v++) {
    const struct vec3 u = less ? vec3_sub(g->state->velocity[v], drawn[v]) : drawn[v];
    to[3 * v] = u.x, to[3 * v + 1] = u.y, to[3 * v + 2] = u.z;
  }
}

/* Velocities are drawn where sums are made. */
bool oracle_run_draw(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  const bool ok = collide_sum(g->state, g->model, c, g->place.step, &g->work->fault);
  put_solvent(g, "out.solvent", c->drawn, 1.0, false);
  put_vertices(g, "out.vertex", c->drawn_vertex, false);
  return ok;
}

bool oracle_run_andersen_sum(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  oracle_put_cells(g, "in.solvent_cell", "in.vertex_cell");
  put_solvent(g, "in.solvent", c->drawn, -1.0, true);
  put_vertices(g, "in.vertex", c->drawn_vertex, true);
  const bool ok = collide_sum(g->state, g->model, c, g->place.step, &g->work->fault);
  oracle_put_sums(g, "out.momentum", "out.load");
  return ok;
}

bool oracle_run_mean(struct oracle_stage *g)
{
  oracle_put_sums(g, "in.momentum", "in.load");
  collide_solve(g->model, &g->work->mpc, g->place.step);
  oracle_put_active(g, "out.active");
  oracle_put_centers(g, "out.center");
  return true;
}

bool oracle_run_give(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  oracle_put_cells(g, "in.solvent_cell", "in.vertex_cell");
  oracle_put_active(g, "in.active");
  oracle_put_centers(g, "in.center");
  put_solvent(g, "in.solvent_drawn", c->drawn, 1.0, false);
  put_vertices(g, "in.vertex_drawn", c->drawn_vertex, false);
  oracle_put_velocities(g, "in.solvent", "in.vertex");
  collide_turn(g->state, g->model, c, false);
  oracle_put_velocities(g, "out.solvent", "out.vertex");
  return true;
}
