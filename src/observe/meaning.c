#include "observe/meaning.h"

#include <string.h>

#include "observe/background.h"
#include "system/fiber_kind.h"
#include "theory/theory.h"

/* --- what a scene may be ----------------------------------------------------------------------------------------- */

static bool anywhere(const struct model *m)
{
  (void)m;
  return true;
}

static bool no_fibers(const struct model *m)
{
  return m->kinds == 0;
}

static bool no_fibers_no_dumbbells(const struct model *m)
{
  return m->kinds == 0 && !model_has_dumbbells(m);
}

static bool no_dumbbells(const struct model *m)
{
  return !model_has_dumbbells(m);
}

static bool no_bead(const struct model *m)
{
  return !model_has_bead(m);
}

static bool no_network(const struct model *m)
{
  return !model_has_bead(m) || m->kinds == 0;
}

static bool no_trap(const struct model *m)
{
  return m->bead.drive.spring == 0.0;
}

static bool no_pair_forces(const struct model *m)
{
  return !model_repels(m);
}

static bool no_particles(const struct model *m)
{
  return !model_has_solvent(m);
}

static bool no_walls(const struct model *m)
{
  return !model_has_walls(m);
}

static bool no_bonds(const struct model *m)
{
  return m->bonds == 0;
}

/* That move something: those between held vertices do not. */
static bool no_forces(const struct model *m)
{
  bool none = !model_has_dumbbells(m) && !model_repels(m);
  for (uint32_t k = 0; k < m->kinds; k++)
    none &= fiber_stands(&m->kind[k]) || m->kind[k].vertices < 2;
  return none;
}

static bool by_a_force_on_fibers(const struct model *m)
{
  bool any = false;
  for (uint32_t k = 0; k < m->kinds; k++)
    any |= vec3_norm(m->kind[k].force) > 0.0;
  return any;
}

static bool accelerated(const struct model *m)
{
  return vec3_norm(background_acceleration(m)) > 0.0;
}

static bool in_a_bath_with_flow(const struct model *m)
{
  return !model_keeps_momentum(m);
}

static bool in_pairs(const struct model *m)
{
  return m->medium.kind == MEDIUM_PAIRS;
}

static bool permuted(const struct model *m)
{
  return model_has_solvent(m) && model_in_cells(m) && !m->solvent.hydrodynamics;
}

static bool inextensible(const struct model *m)
{
  return m->medium.inextensible;
}

static bool drift_split(const struct model *m)
{
  return m->scheme == SCHEME_DRIFT_SPLIT;
}

static bool thick(const struct model *m)
{
  return m->thickness > 0 && m->crossing.forbidden;
}

static bool no_tubes(const struct model *m)
{
  return !thick(m);
}

static bool beside_held(const struct model *m)
{
  return m->held > 0;
}

static bool not_crossable(const struct model *m)
{
  return m->crossing.forbidden;
}

static bool long_and_bending(const struct model *m)
{
  bool any = false;
  for (uint32_t k = 0; k < m->kinds; k++)
    any |= m->kind[k].vertices > 3 && m->kind[k].bending > 0.0 &&
           fiber_contour(&m->kind[k]) > theory_effective_persistence(&m->kind[k]);
  return any;
}

static const struct {
  const char *words; /* of docs/observables.md */
  bool (*holds)(const struct model *model);
} circumstances[CIRCUMSTANCES] = {
    [ANYWHERE] = {"anywhere", anywhere},
    [NO_FIBERS] = {"no fibers", no_fibers},
    [NO_FIBERS_NO_DUMBBELLS] = {"neither fibers nor dumbbells", no_fibers_no_dumbbells},
    [NO_BEAD] = {"no bead", no_bead},
    [NO_NETWORK] = {"no bead, or no fibers", no_network},
    [NO_TRAP] = {"a bead without a trap", no_trap},
    [NO_PAIR_FORCES] = {"no forces of pairs", no_pair_forces},
    [NO_TUBES] = {"no thick fibers that cannot cross", no_tubes},
    [NO_DUMBBELLS] = {"no dumbbells", no_dumbbells},
    [NO_PARTICLES] = {"no solvent particles", no_particles},
    [NO_WALLS] = {"no walls", no_walls},
    [NO_BONDS] = {"no bonds", no_bonds},
    [NO_FORCES] = {"no bonds that move, no dumbbells, no forces of pairs", no_forces},
    [IN_A_PLANE] = {"two dimensions", model_is_flat},
    [IN_SHEAR] = {"sheared box", model_is_sheared},
    [BETWEEN_WALLS] = {"walls", model_has_walls},
    [IN_A_FLOW] = {"a flow that differs from place to place", background_differs},
    [BY_A_FORCE_ON_FIBERS] = {"a force on fibers", by_a_force_on_fibers},
    [ACCELERATED] = {"a net force that nothing takes up", accelerated},
    [IN_A_BATH_WITH_FLOW] = {"phantoms, medium private or overdamped", in_a_bath_with_flow},
    [IN_PAIRS] = {"medium of pairs", in_pairs},
    [PERMUTED] = {"`hydrodynamics: false`", permuted},
    [OVERDAMPED] = {"medium overdamped", model_is_overdamped},
    [INEXTENSIBLE] = {"inextensible", inextensible},
    [DRIFT_SPLIT] = {"`order: drift-split`", drift_split},
    [THICK] = {"thick fibers that cannot cross", thick},
    [BESIDE_HELD] = {"held vertices, or frozen fibers", beside_held},
    [NOT_CROSSABLE] = {"fibers that cannot cross", not_crossable},
    [LONG_AND_BENDING] = {"fibers that bend, longer than their persistence length", long_and_bending},
    [WITH_DUMBBELLS] = {"dumbbells", model_has_dumbbells},
    [WITH_A_BEAD] = {"bead", model_has_bead},
};

const char *meaning_words(enum circumstance where)
{
  return circumstances[where].words;
}

bool meaning_holds(enum circumstance where, const struct model *model)
{
  return circumstances[where].holds(model);
}

/* --- the table --------------------------------------------------------------------------------------------------- */

/* A bead is a place at which momentum leaves what is summed. */
#define GIVEN_TO_BEAD "momentum that the solvent gives to the bead is not in "
#define NO_TENSION "the tension of bonds is not in its stress; allowed without medium.inextensible"
#define LAG "fibers lag behind the accelerated solvent by some v, which counts, as "
#define SOLVENT_LAGS                                                                                                   \
  "with fibers, a drift u of the solvent against the center of mass counts, as m u²/d; about means in slabs it does " \
  "not"
#define IN_STRESS "sigma_xy sigma_xy_fibers N1 N1_fibers pressure"
#define HANDED_ON                                                                                                      \
  "with what contacts hand on, a mean since the row before; contacts that are called rigid hand on nothing"

const struct meaning meanings[] = {
    {OBSERVE_CONSERVED, NO_PAIR_FORCES, LEFT_OUT, "pairs", "no pair has an energy"},
    {OBSERVE_CONSERVED, OVERDAMPED, LEFT_OUT, "solvent_kinetic vertex_kinetic px py pz", "there are no velocities"},
    {OBSERVE_CONSERVED, WITH_DUMBBELLS, MEANS, "bond", "with the energy of springs, and of dumbbells near walls"},
    {OBSERVE_CONSERVED, WITH_A_BEAD, MEANS, "total px py pz", "with the bead"},
    {OBSERVE_CONSERVED, IN_SHEAR, MEANS, "solvent_kinetic vertex_kinetic total",
     "with the energy of the flow; a vertex beyond the box has the velocity of its image"},
    {OBSERVE_CONSERVED, ANYWHERE, MEANS, NULL, "of the laboratory, at the step"},

    {OBSERVE_TEMPERATURE, OVERDAMPED, REFUSED, NULL, "there are no velocities; allowed with another medium"},
    {OBSERVE_TEMPERATURE, NO_PARTICLES, LEFT_OUT, "solvent solvent_x solvent_y solvent_z", "there are no particles"},
    {OBSERVE_TEMPERATURE, NO_FIBERS, LEFT_OUT, "vertex vertex_half_step", "there are no fibers"},
    {OBSERVE_TEMPERATURE, IN_A_PLANE, LEFT_OUT, "solvent_z", "nothing moves along z"},
    {OBSERVE_TEMPERATURE, IN_SHEAR, MEANS, NULL,
     "about the mean of the solvent in slabs of one cell; without solvent particles about the linear flow"},
    {OBSERVE_TEMPERATURE, BETWEEN_WALLS, MEANS, NULL,
     "about the mean of the solvent in slabs of one cell; without solvent about that of all vertices"},
    {OBSERVE_TEMPERATURE, IN_A_FLOW, MEANS, NULL,
     "with a profile, about the mean of the solvent in slabs of one cell; around a bead the flow counts"},
    {OBSERVE_TEMPERATURE, IN_A_BATH_WITH_FLOW, MEANS, NULL, "about `flow`; in a sheared box about its linear flow"},
    {OBSERVE_TEMPERATURE, BY_A_FORCE_ON_FIBERS, MEANS, "vertex vertex_half_step",
     "a drift v against the solvent counts, as M v²/d"},
    {OBSERVE_TEMPERATURE, BY_A_FORCE_ON_FIBERS, MEANS, "solvent solvent_x solvent_y solvent_z", SOLVENT_LAGS},
    {OBSERVE_TEMPERATURE, ACCELERATED, MEANS, "solvent solvent_x solvent_y solvent_z", SOLVENT_LAGS},
    {OBSERVE_TEMPERATURE, ACCELERATED, MEANS, "vertex vertex_half_step", LAG "M v²/d"},
    {OBSERVE_TEMPERATURE, DRIFT_SPLIT, MEANS, "solvent solvent_x solvent_y solvent_z",
     "with forces of pairs, of half a step ahead, when collisions act"},
    {OBSERVE_TEMPERATURE, ANYWHERE, MEANS, NULL, "about the velocity of the center of mass"},

    {OBSERVE_STATICS, ANYWHERE, MEANS, NULL, "of places alone"},

    {OBSERVE_DYNAMICS, IN_SHEAR, REFUSED, NULL,
     "a fiber that leaves a sheared box is replaced by an image, which moves at another speed, so it has no "
     "displacement; allowed without shear"},
    {OBSERVE_DYNAMICS, IN_A_FLOW, LEFT_OUT,
     "d2 d2_contour d2_third D D_about_mean D_cumulative D_cumulative_about_mean",
     "the flow carries a fiber off its old contour, and away from others, which is no diffusion"},
    {OBSERVE_DYNAMICS, IN_A_FLOW, MEANS, "g g_cm g_middle g_cm_about_mean drift_x drift_y drift_z",
     "of the laboratory between walls; with the flow's displacements"},
    {OBSERVE_DYNAMICS, BETWEEN_WALLS, LEFT_OUT, "D D_about_mean D_cumulative D_cumulative_about_mean",
     "the way across is bounded"},
    {OBSERVE_DYNAMICS, BETWEEN_WALLS, MEANS, "g g_cm g_middle", "along and across together"},
    {OBSERVE_DYNAMICS, ACCELERATED, MEANS, NULL, "about `flow` and the acceleration of everything"},
    {OBSERVE_DYNAMICS, BESIDE_HELD, MEANS, NULL, "of the laboratory"},
    {OBSERVE_DYNAMICS, IN_A_PLANE, MEANS, "D D_about_mean D_cumulative D_cumulative_about_mean", "g_cm/4t"},
    {OBSERVE_DYNAMICS, ANYWHERE, MEANS, NULL, "about `flow`"},

    {OBSERVE_COLLISIONS, NO_BONDS, LEFT_OUT, "rate_over_theory", "there is nothing that touches"},
    {OBSERVE_COLLISIONS, THICK, LEFT_OUT, "rate_over_theory", "the theory is that of lines"},
    {OBSERVE_COLLISIONS, BESIDE_HELD, LEFT_OUT, "rate_over_theory", "the theory is that of fibers which all move"},
    {OBSERVE_COLLISIONS, LONG_AND_BENDING, MEANS, "rate_over_theory",
     "the theory has no contacts of such fibers with themselves: above 1 by as many as there are"},
    {OBSERVE_COLLISIONS, IN_SHEAR, MEANS, "rate_over_theory", "over the rate at rest"},
    {OBSERVE_COLLISIONS, BETWEEN_WALLS, MEANS, "rate_over_theory", "over the rate at rest, far from walls"},
    {OBSERVE_COLLISIONS, ANYWHERE, MEANS, NULL, "counts"},

    {OBSERVE_PROFILE, WITH_A_BEAD, REFUSED, NULL,
     "a slab is not full of solvent where the bead is; allowed without a bead"},
    {OBSERVE_PROFILE, NO_PARTICLES, REFUSED, NULL, "there are no solvent particles; allowed with some"},
    {OBSERVE_PROFILE, DRIFT_SPLIT, MEANS, "temperature", "with forces of pairs, of half a step ahead"},
    {OBSERVE_PROFILE, ANYWHERE, MEANS, NULL, "of the solvent; velocities of the laboratory"},

    {OBSERVE_STRESS, WITH_A_BEAD, REFUSED, NULL, GIVEN_TO_BEAD "its stress; allowed without a bead"},
    {OBSERVE_STRESS, INEXTENSIBLE, REFUSED, NULL, NO_TENSION},
    {OBSERVE_STRESS, IN_PAIRS, REFUSED, NULL,
     "it sums what collisions of cells do; allowed without a medium; with this one: observe.pressure"},
    {OBSERVE_STRESS, PERMUTED, REFUSED, NULL,
     "velocities that are permuted carry momentum across the box; allowed with hydrodynamics: true"},
    {OBSERVE_STRESS, BESIDE_HELD, REFUSED, NULL,
     "momentum that held vertices take up is not in its stress; allowed without them"},
    {OBSERVE_STRESS, NO_PARTICLES, LEFT_OUT, "sigma_xy_kinetic sigma_xy_collisional", "there are no particles"},
    {OBSERVE_STRESS, NO_WALLS, LEFT_OUT, "sigma_lower sigma_upper", "there are no walls"},
    {OBSERVE_STRESS, NO_FIBERS_NO_DUMBBELLS, LEFT_OUT, "sigma_xy_spring N1_spring", "there are no springs"},
    {OBSERVE_STRESS, NO_FIBERS, LEFT_OUT, "sigma_xy_fibers N1_fibers", "there are no fibers"},
    {OBSERVE_STRESS, NO_TUBES, LEFT_OUT, "sigma_xy_contacts N1_contacts", "thin fibers hand on nothing at a contact"},
    {OBSERVE_STRESS, THICK, MEANS, "sigma_xy N1 pressure sigma_xy_contacts N1_contacts", HANDED_ON},
    {OBSERVE_STRESS, IN_A_FLOW, MEANS, "N1 pressure", "a flow u that is not linear counts, as −ρ⟨u²⟩"},
    {OBSERVE_STRESS, BY_A_FORCE_ON_FIBERS, MEANS, IN_STRESS,
     "a drift v of fibers against the applied flow counts, as −M v_x v_y per volume in σ_xy"},
    {OBSERVE_STRESS, ACCELERATED, MEANS, IN_STRESS,
     "fibers lag behind everything by some v, which counts, as −M v_x v_y per volume in σ_xy"},
    {OBSERVE_STRESS, IN_A_BATH_WITH_FLOW, MEANS, NULL, "of fibers alone"},
    {OBSERVE_STRESS, BETWEEN_WALLS, MEANS, NULL,
     "of the bulk; of fibers, of the whole gap; about the line between both walls"},
    {OBSERVE_STRESS, ANYWHERE, MEANS, NULL, "about `flow`, in a sheared box about its linear flow"},

    {OBSERVE_DUMBBELLS, NO_DUMBBELLS, REFUSED, NULL, "there are none; allowed with dumbbells"},
    {OBSERVE_DUMBBELLS, ANYWHERE, MEANS, NULL, "of vectors alone"},

    {OBSERVE_ORIENTATION, IN_A_PLANE, MEANS, "S", "the larger eigenvalue of ⟨2 u u − 1⟩"},
    {OBSERVE_ORIENTATION, ANYWHERE, MEANS, NULL, "of directions alone"},

    {OBSERVE_BEAD, NO_BEAD, REFUSED, NULL, "there is none; allowed with a bead"},
    {OBSERVE_BEAD, NO_TRAP, LEFT_OUT, "trap_x trap_y trap_z", "there is no trap"},
    {OBSERVE_BEAD, ANYWHERE, MEANS, NULL, "of the laboratory"},

    {OBSERVE_MEMORY, IN_SHEAR, REFUSED, NULL,
     "it belongs to equilibrium, and the box is sheared; allowed without shear"},
    {OBSERVE_MEMORY, IN_A_FLOW, REFUSED, NULL,
     "it belongs to equilibrium, and the flow differs from place to place; allowed without forces, profile, sliding "
     "walls or a bead that is pulled"},
    {OBSERVE_MEMORY, BY_A_FORCE_ON_FIBERS, REFUSED, NULL,
     "it belongs to equilibrium, and a force pulls fibers; allowed without fibers.force"},
    {OBSERVE_MEMORY, ACCELERATED, REFUSED, NULL,
     "it belongs to equilibrium, and fibers lag behind what a net force accelerates; allowed without a net force"},
    {OBSERVE_MEMORY, INEXTENSIBLE, REFUSED, NULL, NO_TENSION},
    {OBSERVE_MEMORY, OVERDAMPED, LEFT_OUT, "vertices center", "there are no velocities"},
    {OBSERVE_MEMORY, THICK, LEFT_OUT, "stress_memory", "what thick fibers hand on at a contact is not in it"},
    {OBSERVE_MEMORY, BESIDE_HELD, MEANS, NULL, "of kinds that are not frozen; frozen ones have no table"},
    {OBSERVE_MEMORY, IN_A_PLANE, MEANS, "vertices center", "⟨v(0)·v(t)⟩/2"},
    {OBSERVE_MEMORY, IN_A_PLANE, MEANS, "stress_memory", "of xy alone"},
    {OBSERVE_MEMORY, ANYWHERE, MEANS, NULL, "about `flow`"},

    {OBSERVE_PRESSURE, WITH_A_BEAD, REFUSED, NULL, GIVEN_TO_BEAD "it; allowed without a bead"},
    {OBSERVE_PRESSURE, INEXTENSIBLE, REFUSED, NULL, NO_TENSION},
    {OBSERVE_PRESSURE, IN_A_FLOW, REFUSED, NULL,
     "a flow that differs from place to place would count as pressure; allowed without forces between walls, profile, "
     "or sliding walls; with them: observe.stress"},
    {OBSERVE_PRESSURE, NO_FORCES, LEFT_OUT, "configurational", "there is nothing to tell it from"},
    {OBSERVE_PRESSURE, NO_TUBES, LEFT_OUT, "pressure_contacts", "thin fibers hand on nothing at a contact"},
    {OBSERVE_PRESSURE, BESIDE_HELD, LEFT_OUT, "pressure p_xx p_yy p_zz p_xy pressure_contacts",
     "they hold what pushes them"},
    {OBSERVE_PRESSURE, BETWEEN_WALLS, LEFT_OUT, "force_square laplacian configurational",
     "walls push too, which is no force of the energy"},
    {OBSERVE_PRESSURE, IN_A_PLANE, LEFT_OUT, "p_zz", "nothing moves along z"},
    {OBSERVE_PRESSURE, THICK, MEANS, "pressure p_xx p_yy p_zz p_xy pressure_contacts", HANDED_ON},
    {OBSERVE_PRESSURE, IN_SHEAR, MEANS, "pressure p_xx p_yy p_zz p_xy", "about the linear flow"},
    {OBSERVE_PRESSURE, BETWEEN_WALLS, MEANS, "pressure p_xx p_yy p_zz p_xy", "mean over the whole gap"},
    {OBSERVE_PRESSURE, IN_A_BATH_WITH_FLOW, MEANS, "pressure p_xx p_yy p_zz p_xy", "of vertices alone, about `flow`"},
    {OBSERVE_PRESSURE, BY_A_FORCE_ON_FIBERS, MEANS, "pressure p_xx p_yy p_zz p_xy",
     "a drift v against the solvent counts, as M v² per volume"},
    {OBSERVE_PRESSURE, ACCELERATED, MEANS, "pressure p_xx p_yy p_zz p_xy", LAG "M v² per volume"},
    {OBSERVE_PRESSURE, DRIFT_SPLIT, MEANS, "pressure p_xx p_yy p_zz p_xy",
     "velocities of half a step ahead, when collisions act"},
    {OBSERVE_PRESSURE, ANYWHERE, MEANS, NULL, "about `flow`, and about the acceleration of everything"},

    {OBSERVE_WAKE, NO_NETWORK, REFUSED, NULL, "it looks at the fibers around a bead; allowed with both"},
    {OBSERVE_WAKE, ANYWHERE, MEANS, NULL, "of the laboratory"},

    {OBSERVE_TOPOLOGY, NO_BONDS, REFUSED, NULL, "there are no bonds; allowed with some"},
    {OBSERVE_TOPOLOGY, IN_A_PLANE, REFUSED, NULL,
     "in a plane bonds meet and do not cross; allowed in three dimensions"},
    {OBSERVE_TOPOLOGY, IN_SHEAR, REFUSED, NULL,
     "a fiber that leaves a sheared box is replaced by an image; allowed without shear; with it: `uncross topology` of "
     "a trajectory"},
    {OBSERVE_TOPOLOGY, NOT_CROSSABLE, MEANS, NULL,
     "within a step paths bend at contacts, or vertices move one after another: an even number may be false"},
    {OBSERVE_TOPOLOGY, BESIDE_HELD, MEANS, NULL, "without pairs of bonds that stand"},
    {OBSERVE_TOPOLOGY, ANYWHERE, MEANS, NULL, "of straight moves from sample to sample"},
};
const size_t meaning_count = sizeof meanings / sizeof *meanings;

const char *meaning_refusal(const struct model *model, enum observable which)
{
  for (size_t k = 0; k < meaning_count; k++)
    if (meanings[k].of == which && meanings[k].verdict == REFUSED && meaning_holds(meanings[k].where, model))
      return meanings[k].text;
  return NULL;
}

/* Is the word of this length in a list that blanks separate? */
static bool listed(const char *list, const char *word, size_t length)
{
  bool found = false;
  while (!found && *list) {
    const size_t part = strcspn(list, " ");
    found = part == length && memcmp(list, word, length) == 0;
    list += part + (list[part] == ' ');
  }
  return found;
}

bool meaning_has_column(const struct model *model, enum observable which, const char *column)
{
  static const char error[] = "_error";
  const size_t all = strlen(column), tail = sizeof error - 1;
  const size_t length = all > tail && strcmp(column + all - tail, error) == 0 ? all - tail : all;
  bool there = true;
  for (size_t k = 0; k < meaning_count; k++) {
    const struct meaning *m = &meanings[k];
    there &= m->of != which || m->verdict != LEFT_OUT || !listed(m->columns, column, length) ||
             !meaning_holds(m->where, model);
  }
  return there;
}
