#include "mpc/rule.h"

static const struct collision_rule *const rules[RULES] = {
    [RULE_SRD] = &srd_rule, [RULE_AT_A] = &at_a_rule, [RULE_AT_PLUS_A] = &at_plus_a_rule};

const struct collision_rule *collision_rule_of(const struct model *model)
{
  return rules[model->solvent.rule];
}
