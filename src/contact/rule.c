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
  const bool meets = model->bonds > 1 || (model->bonds > 0 && model_has_bead(model));
  return crossing_rule_row(model->crossing.forbidden && meets ? model->crossing.rule : CROSSING_FREE);
}
