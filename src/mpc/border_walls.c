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
#include "mpc/cell.h"
#include "mpc/grid.h"
#include "mpc/rule.h"
#include "mpc/virtual.h"

/* A cell that a wall cuts. */
struct cut {
  enum wall wall;
  uint32_t place; /* in sum and turn */
  double beyond;  /* part of it that is beyond the wall */
  uint32_t members;
};

typedef double fill_number(const struct model *model, uint64_t step, const struct cut *cut);

static double planar(const struct model *model, uint64_t step, const struct cut *cut)
{
  return virtual_number(model, step, cut->place, model->solvent.per_cell * cut->beyond);
}

/* Rounded, so that the cell's mass is exact. */
static double paper(const struct model *model, uint64_t step, const struct cut *cut)
{
  (void)step;
  const double missing = model->solvent.per_cell - cut->members;
  return missing > 0.0 ? nearbyint(missing / MODEL_MASS_UNIT) * MODEL_MASS_UNIT : 0.0;
}

static double none(const struct model *model, uint64_t step, const struct cut *cut)
{
  (void)model, (void)step, (void)cut;
  return 0.0;
}

static fill_number *fill_of(const struct model *model)
{
  static fill_number *const fills[FILLS] = {[FILL_PLANAR] = planar, [FILL_PAPER] = paper, [FILL_NONE] = none};
  return model->walls.kind == WALL_SLIP ? none : fills[model->walls.fill];
}

/* Number k of the cut cells, in the order of mpc->filled. */
static struct cut cut_cell(const struct model *model, const struct mpc *c, uint32_t k)
{
  const struct box *box = &model->box;
  const uint32_t lx = (uint32_t)box->rows[0], ry = (uint32_t)box->rows[1], each = lx * (uint32_t)box->rows[2];
  const enum wall wall = k < each ? WALL_LOWER : WALL_UPPER;
  const uint32_t in_row = k < each ? k : k - each, row = wall == WALL_LOWER ? 0 : ry - 1;
  const uint32_t place = (in_row / lx * ry + row) * lx + in_row % lx;
  const double s = (double)c->shift.y * LATTICE_UNIT;
  return (struct cut){wall, place, wall == WALL_LOWER ? s : 1.0 - s, cell_members(&c->sum[place])};
}

static uint32_t cut_cells(const struct model *model)
{
  return 2 * (uint32_t)model->box.rows[0] * (uint32_t)model->box.rows[2];
}

struct virtual_members border_virtual(const struct mpc *c, const struct model *model, uint32_t place)
{
  const uint32_t lx = (uint32_t)model->box.rows[0], ry = (uint32_t)model->box.rows[1];
  const uint32_t row = place / lx % ry, in_row = place / (lx * ry) * lx + place % lx;
  if (!c->filled || (row != 0 && row != ry - 1))
    return (struct virtual_members){0};
  return c->filled[in_row + (row == 0 ? 0 : lx * (uint32_t)model->box.rows[2])];
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
static bool add(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                const struct cut *cut, const struct virtual_members *v, struct fault *fault)
{
  if (!virtual_room(&c->sum[cut->place], v->n, step, cut->place, FAULT_SOLVENT_SPEED, fault)) {
    if (fault->code == FAULT_SOLVENT_SPEED)
      fault->entity = particle_in(state, c, cut->place);
    return false;
  }
  c->rule->add_virtual(model, c, step, cut->place, v);
  return true;
}

enum { BLOCK = 64 }; /* cells worked on at a time */

static bool fill(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                 struct fault *fault)
{
  const uint32_t cuts = cut_cells(model);
  const struct vec3 wall[WALLS] = {velocity_of(model, WALL_LOWER, step), velocity_of(model, WALL_UPPER, step)};
  fill_number *const number = fill_of(model);
  struct cut cut[BLOCK];
  struct vec3 normal[BLOCK];
  uint32_t place[BLOCK];
  for (uint32_t first = 0; first < cuts; first += BLOCK) {
    const uint32_t m = cuts - first < BLOCK ? cuts - first : BLOCK;
    for (uint32_t k = 0; k < m; k++) {
      cut[k] = cut_cell(model, c, first + k);
      place[k] = cut[k].place;
    }
    if (number != none)
      virtual_normals(model, step, place, m, normal);
    for (uint32_t k = 0; k < m; k++) {
      const bool lower = cut[k].wall == WALL_LOWER;
      const struct vec3 flow = wall[cut[k].wall];
      const double n = number(model, step, &cut[k]), beyond = cut[k].beyond;
      c->filled[first + k] = (struct virtual_members){n, n > 0.0 ? virtual_velocity(normal[k], n, flow) : flow, flow,
                                                      lower ? 0.0 : 1.0 - beyond, lower ? beyond : 1.0};
      if (n > 0.0 && !add(state, model, c, step, &cut[k], &c->filled[first + k], fault))
        return false;
    }
  }
  return true;
}

static void account(struct state *state, const struct model *model, struct mpc *c, uint64_t step)
{
  const uint32_t cuts = cut_cells(model);
  for (uint32_t k = 0; k < cuts; k++) {
    const struct virtual_members *v = &c->filled[k];
    const struct cut cut = cut_cell(model, c, k);
    if (v->n > 0.0)
      account_enter(account_of(state, ACCOUNT_COLLISIONS), cut.wall,
                    vec3_scale(-1.0, c->rule->virtual_gain(model, c, step, cut.place, v, c->thermostat != NULL)));
  }
}

const struct border border_walls = {.name = "walls",
                                    .bin_particles = grid_bin_particles,
                                    .bin_vertices = grid_bin_vertices,
                                    .fill = fill,
                                    .account = account};
