/*
 * Virtual particles. A cell that the surface cuts holds particles of mass 1 in the part inside: of a Poisson number of
 * mean gamma, uniform in the cell, those count that are inside. They are a part of the bead's own matter, which has the
 * mass M, the total momentum M V and the temperature kT. So their mean velocity in cell i, n_i of them, is
 *
 *   v_i = V + g_i - (sum_j n_j g_j + m_0 g_0)/M,   g_i normal of variance kT/n_i,   m_0 = M - sum_j n_j, g_0: kT/m_0
 *
 * per component: drawn anew at the given total momentum. The bead takes what they gain: V += sum_i n_i (v_i' - v_i)/M.
 * With independent velocities (no last term) the bead would be too hot, by about half of sum n/M. Cells without other
 * members are left out, and cells beyond those whose particles have together the mass M.
 */
#include "base/memory.h"
#include "base/normal.h"
#include "bead/collide.h"
#include "mpc/cell.h"
#include "mpc/rule.h"
#include "mpc/virtual.h"

/* Walls that fill cells, too, have the random numbers of the cells' own numbers: the bead has others. */
static uint32_t aside_of(const struct mpc *c)
{
  return c->filled ? c->cells : 0;
}

/* Of the virtual particles of a cell, those inside the bead. aside: as in struct virtual_members; corner: of the cell,
 * from the bead's center, a0. */
static uint32_t count_inside(const struct virtual_law *law, const struct model *model, uint64_t step, uint32_t cell,
                             uint32_t aside, const double corner[3])
{
  const uint32_t n = virtual_number(law, model, step, cell + aside);
  const double square = model->bead.radius * model->bead.radius;
  uint32_t inside = 0;
  for (uint32_t k = 0; k < n; k++) {
    const struct random_words r = random_at(model->seed, RANDOM_BEAD_PLACE, k, step, cell);
    double d = 0.0;
    for (int axis = 0; axis < 3; axis++) {
      const double x = corner[axis] + ((double)r.w[axis] + 0.5) * 0x1p-32;
      d += x * x;
    }
    inside += d < square;
  }
  return inside;
}

enum { MOST_CUTS_AT_FIRST = 256 };

/* Room for twice as many cells as there are. */
static bool widen(struct bead_cuts *b)
{
  uint32_t rooms[3] = {b->room, b->room, b->room};
  const bool ok = memory_double((void **)&b->cut, &rooms[0], MOST_CUTS_AT_FIRST, sizeof *b->cut) &&
                  memory_double((void **)&b->number, &rooms[1], MOST_CUTS_AT_FIRST, sizeof *b->number) &&
                  memory_double((void **)&b->normal, &rooms[2], MOST_CUTS_AT_FIRST, sizeof *b->normal);
  b->room = ok ? rooms[0] : b->room;
  return ok;
}

static bool add_cut(struct bead_cuts *b, uint32_t cell, uint32_t n, uint64_t step, struct fault *fault)
{
  if (b->count == b->room && !widen(b))
    return fault_no_memory(fault, step);
  b->cut[b->count++] = (struct bead_cut){.cell = cell, .n = n};
  return true;
}

/* All of one line of cells along x. */
static bool cut_line(struct bead_cuts *cuts, const struct surround *s, const struct virtual_law *law,
                     const struct model *model, const struct mpc *c, int64_t y, int64_t z, uint64_t step,
                     struct fault *fault)
{
  const double square = model->bead.radius * model->bead.radius;
  const double least = surround_least(s, 2, z) + surround_least(s, 1, y);
  const double largest = surround_largest(s, 2, z) + surround_largest(s, 1, y);
  for (int64_t x = s->low[0]; x <= s->high[0]; x++) {
    if (!(least + surround_least(s, 0, x) < square && largest + surround_largest(s, 0, x) > square))
      continue;
    const uint32_t cell = surround_cell(&model->box, x, y, z);
    if (cell_members(&c->sum[cell]) == 0)
      continue;
    const double corner[3] = {(double)x - s->center[0], (double)y - s->center[1], (double)z - s->center[2]};
    const uint32_t n = count_inside(law, model, step, cell, aside_of(c), corner);
    if (n > 0 && !add_cut(cuts, cell, n, step, fault))
      return false;
  }
  return true;
}

/* Cells whose particles have more than the mass of the bead together are dropped. Returns what is left of the mass. */
static double rest_mass(const struct model *model, struct bead_cuts *b)
{
  double rest = model->bead.mass;
  uint32_t kept = 0;
  while (kept < b->count && b->cut[kept].n <= rest)
    rest -= b->cut[kept++].n;
  b->count = kept;
  return rest;
}

/* Velocities of the virtual particles, at the total momentum of the bead. */
static void draw_velocities(const struct bead *bead, const struct model *model, struct bead_cuts *b, uint32_t aside,
                            uint64_t step)
{
  const double rest = rest_mass(model, b);
  double own[3];
  random_normal_three(random_at(model->seed, RANDOM_BEAD_REST, 0, step, 0), own);
  struct vec3 sum = vec3_scale(sqrt(rest), (struct vec3){own[0], own[1], own[2]});
  for (uint32_t k = 0; k < b->count; k++)
    b->number[k] = b->cut[k].cell + aside;
  virtual_normals(model, step, b->number, b->count, b->normal);
  for (uint32_t k = 0; k < b->count; k++)
    sum = vec3_add_scaled(sum, sqrt(b->cut[k].n), b->normal[k]);
  const struct vec3 flow = vec3_add_scaled(bead->velocity, -1.0 / model->bead.mass, sum);
  for (uint32_t k = 0; k < b->count; k++)
    b->cut[k].members = (struct virtual_members){
        .n = b->cut[k].n, .velocity = virtual_velocity(b->normal[k], b->cut[k].n, flow), .flow = flow, .aside = aside};
}

bool bead_fill(void *room, const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
               struct fault *fault)
{
  struct bead_cuts *cuts = &((struct bead_work *)room)->cuts;
  const struct surround s = bead_surround(state->bead, model, c, model->bead.radius);
  struct virtual_law law;
  virtual_law_of(model->solvent.per_cell, &law);
  cuts->count = 0;
  for (int64_t z = s.low[2]; z <= s.high[2]; z++)
    for (int64_t y = s.low[1]; y <= s.high[1]; y++)
      if (!cut_line(cuts, &s, &law, model, c, y, z, step, fault))
        return false;
  draw_velocities(state->bead, model, cuts, aside_of(c), step);
  for (uint32_t k = 0; k < cuts->count; k++) {
    const struct bead_cut *cut = &cuts->cut[k];
    if (!virtual_room(&c->sum[cut->cell], cut->n, step, cut->cell, FAULT_SOLVENT_SPEED, fault))
      return false;
    c->rule->add_virtual(model, c, step, cut->cell, &cut->members);
  }
  return true;
}

/* The bead takes the momentum that its virtual particles gain. They keep the energy that they have gained: what the
 * bead gains beyond that is heat from its matter. */
void bead_take_gain(const struct bead_cuts *cuts, struct state *state, const struct model *model, struct mpc *c,
                    uint64_t step)
{
  struct point sum = {0, 0, 0};
  uint64_t turns = 0;
  struct bead *bead = state->bead;
  int64_t taken = 0;
  for (uint32_t k = 0; k < cuts->count; k++) {
    const struct bead_cut *cut = &cuts->cut[k];
    const struct vec3 gain = c->rule->virtual_gain(model, c, step, cut->cell, &cut->members, false);
    account_add(&sum, &turns, gain);
    bead_account(&taken, vec3_dot(gain, vec3_add_scaled(cut->members.velocity, 0.5 / cut->n, gain)));
  }
  const struct vec3 gain = account_between((struct point){0, 0, 0}, sum);
  bead_account(&bead->account.x, vec3_dot(gain, vec3_add_scaled(bead->velocity, 0.5 / model->bead.mass, gain)));
  bead->account.x = (int64_t)((uint64_t)bead->account.x - (uint64_t)taken);
  bead->velocity = vec3_add_scaled(bead->velocity, 1.0 / model->bead.mass, gain);
}
