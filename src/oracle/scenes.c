/* Which scenes have an operator, or a table. */
#include "contact/rule.h"
#include "oracle/schema.h"

bool oracle_has_events(const struct model *model)
{
  const struct crossing_rule *rule = crossing_rule_of(model);
  return rule->forbids && !rule->in_turns;
}

bool oracle_scene_is(enum oracle_scenes scenes, const struct model *m)
{
  const bool company = model_has_bead(m) && m->kinds > 0; /* drifts and collisions with a bead are no operators yet */
  const bool events = oracle_has_events(m) && !company, solvent = model_has_solvent(m) && model_in_cells(m) && !company;
  const bool moving = !model_is_overdamped(m), pairs = m->medium.kind == MEDIUM_PAIRS;
  const bool walls = model_has_walls(m), shear = model_is_sheared(m), periodic = !walls && !shear;
  const bool dumbbells = model_has_dumbbells(m), srd = m->solvent.rule == RULE_SRD;
  const bool holds[ORACLE_SCENES] = {
      [OF_ALL] = true,
      [OF_FIBERS] = periodic,
      [OF_TURNS] = periodic && !oracle_has_events(m) && moving,
      [OF_EVENTS] = events,
      [OF_TUBES] = events && m->thickness > 0,
      [OF_THICK] = m->thickness > 0,
      [OF_COMPANY] = company,
      [OF_SOLVENT] = solvent,
      [OF_SRD] = solvent && srd,
      [OF_ANDERSENS] = solvent && !srd,
      [OF_ANDERSEN] = solvent && m->solvent.rule == RULE_AT_A,
      [OF_SPIN] = solvent && m->solvent.rule == RULE_AT_PLUS_A,
      [OF_OTHER_RULE] = !srd,
      [OF_PERIODIC_POINTS] = solvent && periodic && !dumbbells,
      [OF_CELLS] = solvent && !walls,
      [OF_FLOW] = !periodic,
      [OF_BETWEEN_WALLS] = walls,
      [OF_OSCILLATION] = !periodic && m->wave.intervals > 0,
      [OF_WALLS] = solvent && walls,
      [OF_SHEAR] = solvent && shear,
      [OF_WAVE] = solvent && shear && m->wave.intervals > 0,
      [OF_LAYERS] = solvent && !periodic && srd,
      [OF_HOMOGENEOUS] = solvent && periodic && srd,
      [OF_WALL_POINTS] = solvent && walls && !dumbbells,
      [OF_SHEAR_POINTS] = solvent && shear && !dumbbells,
      [OF_DUMBBELLS] = dumbbells,
      [OF_PERIODIC_DUMBBELLS] = dumbbells && periodic,
      [OF_WALL_DUMBBELLS] = dumbbells && walls,
      [OF_SHEAR_DUMBBELLS] = dumbbells && shear,
      [OF_MOVING] = periodic && moving,
      [OF_STREAM] = (solvent && periodic && !dumbbells) || pairs,
      [OF_MEDIUM] = !model_in_cells(m),
      [OF_PRIVATE] = m->medium.kind == MEDIUM_PRIVATE,
      [OF_PAIRS] = pairs,
      [OF_REPULSION] = model_repels(m),
      [OF_CROWD] = m->medium.many.repulsion != 0.0,
      [OF_OVERDAMPED] = !moving,
      [OF_TENSOR] = !moving && m->medium.tensor != TENSOR_NONE,
  };
  return holds[scenes];
}
