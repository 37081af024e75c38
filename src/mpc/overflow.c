#include "mpc/overflow.h"

#include "mpc/cell.h"
#include "mpc/rule.h"

/* The member with the largest value of a quantity, and the fault that names it. */
struct culprit {
  double value;
  enum fault_code code;
  int64_t who;
};

/* The size of a velocity's largest component; infinite if one is not a number. */
static double largest_component(struct vec3 v)
{
  double largest = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
  return isnan(v.x + v.y + v.z) ? INFINITY : largest;
}

static void take_larger(struct culprit *f, double value, enum fault_code code, int64_t who)
{
  if (value > f->value)
    *f = (struct culprit){value, code, who};
}

/* The member with the largest component of momentum. */
static struct culprit find_fastest(const struct state *state, const struct model *model)
{
  const struct solvent *s = &state->solvent;
  struct culprit f = {0.0, FAULT_SOLVENT_SPEED, -1};
  for (uint32_t i = 0; i < s->n; i++)
    take_larger(&f, largest_component(solvent_velocity(s, i)), FAULT_SOLVENT_SPEED, s->id[i]);
  for (uint32_t v = 0; v < state->vertices; v++)
    take_larger(&f, model->mass[v] * largest_component(state->velocity[v]), FAULT_VERTEX_SPEED, v);
  return f;
}

static struct culprit find_hottest(const struct state *state, const struct model *model, const struct mpc *c)
{
  const struct solvent *s = &state->solvent;
  struct culprit f = {0.0, FAULT_SOLVENT_ENERGY, -1};
  for (uint32_t i = 0; i < s->n; i++)
    take_larger(&f, cell_energy(&c->turn[c->solvent_cell[i]], 1.0, solvent_velocity(s, i)), FAULT_SOLVENT_ENERGY,
                s->id[i]);
  for (uint32_t v = 0; v < state->vertices; v++)
    take_larger(&f, cell_energy(&c->turn[c->vertex_cell[v]], model->mass[v], state->velocity[v]), FAULT_VERTEX_ENERGY,
                v);
  return f;
}

static bool blame(struct culprit c, double limit, uint64_t step, struct fault *fault)
{
  return fault_record(fault, c.code, step, c.who, c.value, limit);
}

/* Members of the fullest cell. They are the upper bits of its load. */
static uint32_t most_members(const struct mpc *c)
{
  struct cell_sum fullest = {0};
  for (uint32_t k = 0; k < c->cells; k++)
    fullest.load = c->sum[k].load > fullest.load ? c->sum[k].load : fullest.load;
  return cell_members(&fullest);
}

/* The fullest cell, as its place in sum and turn. */
static uint32_t fullest_cell(const struct mpc *c)
{
  uint32_t most = 0, where = 0;
  for (uint32_t k = 0; k < c->cells; k++)
    if (cell_members(&c->sum[k]) > most) {
      most = cell_members(&c->sum[k]);
      where = k;
    }
  return where;
}

/* The largest momentum that a thermal rule may have drawn: normal deviates are below 9 (random_uniform). */
static double most_drawn(const struct model *model, const struct mpc *c)
{
  return c->rule->thermal ? 9.0 * sqrt(model->max_mass) : 0.0;
}

/* The most that a momentum may be in a cell of so many members: their sum must fit in 63 bits. */
static double momentum_limit(uint32_t members)
{
  return 0x1p63 * CELL_MOMENTUM_UNIT / members;
}

/* The span may be up to twice the largest momentum. */
static bool fits(uint64_t span, double limit)
{
  return ((double)span + 1.0) * CELL_MOMENTUM_UNIT < limit;
}

/* The most that a cell's mass may be. */
static const double heaviest = 0x1p40 * CELL_MASS_UNIT;

bool overflow_may_be(const struct model *model, uint64_t span, uint64_t loads)
{
  const uint32_t most = cell_members(&(struct cell_sum){.load = loads});
  return !fits(span, momentum_limit(most)) || !(most * model->max_mass < heaviest);
}

/* Members times the largest momentum must fit in 63 bits, and members times the largest mass in 40. */
bool overflow_of_momenta(const struct state *state, const struct model *model, const struct mpc *c, uint64_t span,
                         uint64_t step, struct fault *fault)
{
  const uint32_t most = most_members(c);
  const double limit = momentum_limit(most);
  if (!fits(span, limit)) {
    const struct culprit fastest = find_fastest(state, model);
    if (!(fastest.value + most_drawn(model, c) + CELL_MOMENTUM_UNIT < limit))
      return blame(fastest, limit, step, fault);
  }
  const double mass = most * model->max_mass;
  return mass < heaviest || fault_record(fault, FAULT_CELL_MASS, step, mpc_cell(c, fullest_cell(c)), mass, heaviest);
}

/* The most that a cell's energy may be, kT: 63 bits. */
static const double hottest_cell = 0x1p63 * CELL_ENERGY_UNIT;

/* At least each energy that went into this span, kT. */
static double energy_bound(uint64_t span)
{
  return ((double)span + 1.0) * CELL_ENERGY_UNIT;
}

bool overflow_of_energies_may_be(uint64_t span, uint64_t loads)
{
  const uint32_t most = cell_members(&(struct cell_sum){.load = loads});
  return !(energy_bound(span) * most < hottest_cell);
}

/* Members times the largest energy must fit. The span may be up to twice the largest, and mostly it fits even if all
 * members are in one cell. */
bool overflow_of_energies(const struct state *state, const struct model *model, const struct mpc *c, uint64_t span,
                          uint64_t step, struct fault *fault)
{
  const double bound = energy_bound(span);
  if (bound * ((double)state->solvent.n + state->vertices) < hottest_cell)
    return true;
  const double limit = hottest_cell / most_members(c);
  if (bound < limit)
    return true;
  const struct culprit hottest = find_hottest(state, model, c);
  return hottest.value + CELL_ENERGY_UNIT < limit || blame(hottest, limit, step, fault);
}
