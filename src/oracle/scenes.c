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
  const bool moving = !model_is_overdamped(m), pairs = m->medium.kind == MEDIUM_PAIRS, thick = m->thickness > 0;
  const bool walls = model_has_walls(m), shear = model_is_sheared(m), periodic = !walls && !shear;
  const bool dumbbells = model_has_dumbbells(m), srd = m->solvent.rule == RULE_SRD;
#define SCENES(name, words, condition) [name] = (condition),
  const bool holds[] = {
#include "oracle/scenes_list.h"
  };
#undef SCENES
  return holds[scenes];
}

const char *oracle_scenes_words(enum oracle_scenes scenes)
{
#define SCENES(name, words, condition) [name] = (words),
  static const char *const all[] = {
#include "oracle/scenes_list.h"
  };
#undef SCENES
  return all[scenes];
}
