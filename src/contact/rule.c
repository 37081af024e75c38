#include "contact/rule.h"

const struct crossing_rule *crossing_rule_row(enum crossing_kind kind)
{
  static const struct crossing_rule *const rules[CROSSINGS] = {[CROSSING_FREE] = &free_rule,
                                                               [CROSSING_SEQUENTIAL] = &sequential_rule,
                                                               [CROSSING_EVENT_DRIVEN] = &event_driven_rule};
  return rules[kind];
}

const struct crossing_rule *crossing_rule_of(const struct model *model)
{
  return crossing_rule_row(model->crossing.forbidden && model_bonds_meet(model) ? model->crossing.rule : CROSSING_FREE);
}
