/*
 * Collisions between walls at y = 0 and y = L (Tao, Goetze and Gompper 2008). The grid is not wrapped along y. With a
 * shift s of the grid, 0 <= s < 1, it has L + 1 rows of cells. Of those in row 0 the part s is beyond the lower wall,
 * of those in row L the part 1 - s is beyond the upper one. In both rows every cell is filled up with virtual
 * particles, whose mean velocity is that of the wall:
 *
 *   planar  a Poisson number of mean gamma times the part beyond the wall: cells are filled as those of the bulk
 *   paper   gamma - N of them where the cell has N < gamma members, else none (the paper's rule)
 *   none    none; nor at slip walls
 */
#include <string.h>

#include "mpc/cell.h"
#include "mpc/grid.h"
#include "mpc/rule.h"
#include "mpc/virtual.h"
#include "wall/motion.h"

enum { BLOCK = 64 }; /* cells worked on at a time */

/* Cells that one wall cuts. */
struct cuts {
  enum wall wall;
  double beyond; /* part of each that is beyond the wall */
  uint32_t count;
  uint32_t place[BLOCK]; /* in sum and turn */
};

/* Numbers of virtual particles: n[cuts->count]. law: of the numbers in what is beyond the wall. */
typedef void fill_numbers(const struct virtual_law *law, const struct model *model, const struct mpc *c, uint64_t step,
                          const struct cuts *cuts, double *n);

static void planar(const struct virtual_law *law, const struct model *model, const struct mpc *c, uint64_t step,
                   const struct cuts *cuts, double *n)
{
  (void)c;
  uint32_t drawn[BLOCK];
  virtual_numbers(law, model, step, cuts->place, cuts->count, drawn);
  for (uint32_t k = 0; k < cuts->count; k++)
    n[k] = drawn[k];
}

/* Rounded, so that the cell's mass is exact. */
static void paper(const struct virtual_law *law, const struct model *model, const struct mpc *c, uint64_t step,
                  const struct cuts *cuts, double *n)
{
  (void)law, (void)step;
  for (uint32_t k = 0; k < cuts->count; k++) {
    const double missing = model->solvent.per_cell - cell_members(&c->sum[cuts->place[k]]);
    n[k] = missing > 0.0 ? nearbyint(missing / MODEL_MASS_UNIT) * MODEL_MASS_UNIT : 0.0;
  }
}

static void none(const struct virtual_law *law, const struct model *model, const struct mpc *c, uint64_t step,
                 const struct cuts *cuts, double *n)
{
  (void)law, (void)model, (void)c, (void)step;
  memset(n, 0, cuts->count * sizeof *n);
}

static fill_numbers *fill_of(const struct model *model)
{
  static fill_numbers *const fills[FILLS] = {[FILL_PLANAR] = planar, [FILL_PAPER] = paper, [FILL_NONE] = none};
  return model->walls.kind == WALL_SLIP ? none : fills[model->walls.fill];
}

static double part_beyond(const struct mpc *c, enum wall wall)
{
  const double s = (double)c->shift.y * LATTICE_UNIT;
  return wall == WALL_LOWER ? s : 1.0 - s;
}

/* The number of cells that each wall cuts. In mpc->filled, those of the lower wall come first. */
static uint32_t cut_cells(const struct model *model)
{
  return (uint32_t)model->box.rows[0] * (uint32_t)model->box.rows[2];
}

/* Cells from number `first` on among those that this wall cuts. */
static struct cuts cuts_from(const struct model *model, const struct mpc *c, enum wall wall, uint32_t first)
{
  const uint32_t lx = (uint32_t)model->box.rows[0], ry = (uint32_t)model->box.rows[1],
                 row = wall == WALL_LOWER ? 0 : ry - 1, left = cut_cells(model) - first;
  struct cuts cuts = {.wall = wall, .beyond = part_beyond(c, wall), .count = left < BLOCK ? left : BLOCK};
  for (uint32_t k = 0; k < cuts.count; k++)
    cuts.place[k] = ((first + k) / lx * ry + row) * lx + (first + k) % lx;
  return cuts;
}

struct virtual_members border_virtual(const struct mpc *c, const struct model *model, uint32_t place)
{
  const uint32_t lx = (uint32_t)model->box.rows[0], ry = (uint32_t)model->box.rows[1];
  const uint32_t row = place / lx % ry, in_row = place / (lx * ry) * lx + place % lx;
  if (!c->filled || (row != 0 && row != ry - 1))
    return (struct virtual_members){0};
  return c->filled[in_row + (row == 0 ? 0 : cut_cells(model))];
}

/* The velocity of a wall at the collision of this step. */
static struct vec3 velocity_of(const struct model *model, enum wall wall, uint64_t step)
{
  return shear_wall_velocity_at_end(model, wall, step / model->solvent.interval_steps - 1);
}

/* A particle of the cell at this place. */
static int64_t particle_in(const struct state *state, const struct mpc *c, uint32_t place)
{
  uint32_t i = 0;
  while (i + 1 < state->solvent.n && c->solvent_cell[i] != place)
    i++;
  return state->solvent.id[i];
}

/* Adds virtual particles, not none, to a cut cell. */
static bool add(const struct state *state, const struct model *model, struct mpc *c, uint64_t step, uint32_t place,
                const struct virtual_members *v, struct fault *fault)
{
  if (!virtual_room(&c->sum[place], v->n, step, place, FAULT_SOLVENT_SPEED, fault)) {
    if (fault->code == FAULT_SOLVENT_SPEED)
      fault->entity = particle_in(state, c, place);
    return false;
  }
  c->rule->add_virtual(model, c, step, place, v);
  return true;
}

/* Fills cells that a wall cuts, whose velocity is `flow`. filled: theirs of mpc->filled. */
static bool fill_cuts(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                      const struct virtual_law *law, const struct cuts *cuts, struct vec3 flow,
                      struct virtual_members *filled, struct fault *fault)
{
  fill_numbers *const numbers = fill_of(model);
  const bool lower = cuts->wall == WALL_LOWER;
  const double bottom = lower ? 0.0 : 1.0 - cuts->beyond, top = lower ? cuts->beyond : 1.0;
  double n[BLOCK];
  struct vec3 normal[BLOCK];
  numbers(law, model, c, step, cuts, n);
  if (numbers != none)
    virtual_normals(model, step, cuts->place, cuts->count, normal);
  for (uint32_t k = 0; k < cuts->count; k++) {
    filled[k] = (struct virtual_members){.n = n[k],
                                         .velocity = n[k] > 0.0 ? virtual_velocity(normal[k], n[k], flow) : flow,
                                         .flow = flow,
                                         .low = bottom,
                                         .high = top};
    if (n[k] > 0.0 && !add(state, model, c, step, cuts->place[k], &filled[k], fault))
      return false;
  }
  return true;
}

static bool fill(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                 struct fault *fault)
{
  const uint32_t each = cut_cells(model);
  for (enum wall wall = 0; wall < WALLS; wall++) {
    const struct vec3 flow = velocity_of(model, wall, step);
    struct virtual_law law;
    virtual_law_of(fill_of(model) == planar ? model->solvent.per_cell * part_beyond(c, wall) : 0.0, &law);
    for (uint32_t first = 0; first < each; first += BLOCK) {
      const struct cuts cuts = cuts_from(model, c, wall, first);
      if (!fill_cuts(state, model, c, step, &law, &cuts, flow, &c->filled[wall * each + first], fault))
        return false;
    }
  }
  return true;
}

static void account(struct state *state, const struct model *model, struct mpc *c, uint64_t step)
{
  const uint32_t each = cut_cells(model);
  for (enum wall wall = 0; wall < WALLS; wall++)
    for (uint32_t first = 0; first < each; first += BLOCK) {
      const struct cuts cuts = cuts_from(model, c, wall, first);
      const struct virtual_members *v = &c->filled[wall * each + first];
      for (uint32_t k = 0; k < cuts.count; k++)
        if (v[k].n > 0.0)
          account_enter(
              account_of(state, ACCOUNT_COLLISIONS), wall,
              vec3_scale(-1.0, c->rule->virtual_gain(model, c, step, cuts.place[k], &v[k], c->thermostat != NULL)));
    }
}

const struct border border_walls = {.name = "walls",
                                    .bin_particles = grid_bin_particles,
                                    .bin_vertices = grid_bin_vertices,
                                    .fill = fill,
                                    .account = account};
