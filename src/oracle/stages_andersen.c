/* The operators of a collision by the rules at-a and at+a, each alone: docs/port/contract.md, *The rule at-a* and *The
 * rule at+a*. `sum` is in stages_solvent.c: here its velocities are those less the drawn ones. */
#include "mpc/collide.h"
#include "mpc/rules/spin.h"
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

/* --- at+a -------------------------------------------------------------------------------------------------------- */

/* Places in cells, relative to their middles. */
static void put_places(struct oracle_stage *g)
{
  const struct solvent *s = &g->state->solvent;
  const struct point shift = g->work->mpc.shift;
  int64_t *to = oracle_put_integers(g, "in.solvent_place", "x y z", s->n);
  for (uint32_t id = 0; to && id < s->n; id++) {
    const uint32_t i = g->slot[id];
    const struct point y = spin_place((struct point){s->x[i], s->y[i], s->z[i]}, shift);
    to[3 * id] = y.x, to[3 * id + 1] = y.y, to[3 * id + 2] = y.z;
  }
  to = oracle_put_integers(g, "in.vertex_place", "x y z", g->state->vertices);
  for (uint32_t v = 0; to && v < g->state->vertices; v++) {
    const struct point y = spin_place(g->state->position[v], shift);
    to[3 * v] = y.x, to[3 * v + 1] = y.y, to[3 * v + 2] = y.z;
  }
}

/* The moments of all cells; zeros where a cell does not collide. */
static void put_moments(struct oracle_stage *g, bool in, bool middle)
{
  const struct mpc *c = &g->work->mpc;
  const uint32_t cells = oracle_cells(g);
  double *beyond = oracle_put_reals(g, in ? "in.beyond" : "out.beyond", "x y z", cells);
  double *second = oracle_put_reals(g, in ? "in.second" : "out.second", "xx yy zz yz zx xy", cells);
  double *angular = oracle_put_reals(g, in ? "in.angular" : "out.angular", "x y z", cells);
  int64_t *place = middle ? oracle_put_integers(g, "out.middle", "x y z", cells) : NULL;
  for (uint32_t k = 0; beyond && second && angular && k < cells; k++) {
    struct cell_turn turn = {.active = 0.0};
    struct spin_moments m;
    cell_solve(&c->sum[k], &turn);
    if (turn.active == 0.0)
      continue;
    spin_moments(&c->sum[k], &c->spin[k], turn.center, &m);
    beyond[3 * k] = m.beyond.x, beyond[3 * k + 1] = m.beyond.y, beyond[3 * k + 2] = m.beyond.z;
    angular[3 * k] = m.angular.x, angular[3 * k + 1] = m.angular.y, angular[3 * k + 2] = m.angular.z;
    for (int i = 0; i < 6; i++)
      second[6 * k + i] = m.second[i];
    if (place)
      place[3 * k] = m.middle.x, place[3 * k + 1] = m.middle.y, place[3 * k + 2] = m.middle.z;
  }
}

bool oracle_run_moments(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  oracle_put_cells(g, "in.solvent_cell", "in.vertex_cell");
  put_places(g);
  put_solvent(g, "in.solvent", c->drawn, -1.0, true);
  put_vertices(g, "in.vertex", c->drawn_vertex, true);
  oracle_put_sums(g, "in.momentum", "in.load");
  put_moments(g, false, true);
  return true;
}

bool oracle_run_spin(struct oracle_stage *g)
{
  oracle_put_sums(g, "in.momentum", "in.load");
  put_moments(g, true, false);
  collide_solve(g->model, &g->work->mpc, g->place.step);
  oracle_put_active(g, "out.active");
  oracle_put_centers(g, "out.center");
  oracle_put_axes(g, "out.omega");
  return true;
}

bool oracle_run_give_spin(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  const uint32_t cells = oracle_cells(g);
  oracle_put_cells(g, "in.solvent_cell", "in.vertex_cell");
  put_places(g);
  oracle_put_active(g, "in.active");
  oracle_put_centers(g, "in.center");
  oracle_put_axes(g, "in.omega");
  int64_t *middle = oracle_put_integers(g, "in.middle", "x y z", cells);
  for (uint32_t k = 0; middle && k < cells; k++)
    if (c->turn[k].active != 0.0)
      middle[3 * k] = c->middle[k].x, middle[3 * k + 1] = c->middle[k].y, middle[3 * k + 2] = c->middle[k].z;
  put_solvent(g, "in.solvent_drawn", c->drawn, 1.0, false);
  put_vertices(g, "in.vertex_drawn", c->drawn_vertex, false);
  oracle_put_velocities(g, "in.solvent", "in.vertex");
  collide_turn(g->state, g->model, c, false);
  oracle_put_velocities(g, "out.solvent", "out.vertex");
  return true;
}
