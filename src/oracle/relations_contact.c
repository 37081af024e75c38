/* Single tests for a crossing and single exchanges, made with one thing changed. */
#include <math.h>
#include <string.h>

#include "oracle/contact_model.h"
#include "oracle/patterns.h"
#include "oracle/relations.h"

static const struct pack_table *input_of(const struct evidence_part *part, const char *name)
{
  return oracle_sibling(&part->pair, name);
}

/* --- tests -------------------------------------------------------------------------------------------------------- */

static bool points_of(const struct evidence_part *part, uint32_t row, struct contact_points *r)
{
  static const char *const names[5] = {"in.from", "in.to", "in.pivot", "in.a", "in.b"};
  const struct pack_table *flip = input_of(part, "in.flip");
  struct point at[5];
  for (int k = 0; k < 5; k++) {
    const struct pack_table *t = input_of(part, names[k]);
    if (!oracle_is_vectors(t, false, row))
      return false;
    at[k] = oracle_point(t, row);
  }
  *r = (struct contact_points){at[0], at[1], at[2], at[3], at[4], flip && pack_value(flip, row, 0) != 0.0};
  return flip != NULL;
}

static double verdict(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  struct contact_points r;
  (void)column;
  return points_of(part, row, &r) ? contact_crosses(twist, &r) : NAN;
}

/* Hits are described where ours has one; elsewhere they are zeros. */
static double description(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *crosses = input_of(part, "out.crosses");
  struct contact_points r;
  if (!crosses || column > 5 || !points_of(part, row, &r))
    return NAN;
  if (pack_value(crosses, row, 0) == 0.0)
    return 0.0;
  const struct contact_hit h = contact_describe(twist, &r);
  const double value[6] = {h.time, h.s, h.s_standing, h.normal.x, h.normal.y, h.normal.z};
  return value[column];
}

static bool tests(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  const bool verdicts = strcmp(e->part[0].pair.ours->name, "out.crosses") == 0;
  if (!contact_test_twists[k].text)
    return false;
  relation_fill(e, verdicts ? verdict : description, &contact_test_twists[k]);
  return relation_say(text, "%s", contact_test_twists[k].text);
}

/* --- exchanges ---------------------------------------------------------------------------------------------------- */

static double exchanged(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  static const char *const names[4] = {"in.moving", "in.pivot", "in.a", "in.b"};
  const struct pack_table *masses = input_of(part, "in.mass"), *contact = input_of(part, "in.contact");
  const struct pack_table *normal = input_of(part, "in.normal");
  struct vec3 v[4];
  double mass[4];
  if (!masses || !contact || masses->columns != 4 || contact->columns != 2 || !oracle_is_vectors(normal, true, row))
    return NAN;
  for (uint32_t k = 0; k < 4; k++) {
    const struct pack_table *t = input_of(part, names[k]);
    if (!oracle_is_vectors(t, true, row))
      return NAN;
    v[k] = oracle_vector(t, row), mass[k] = pack_value(masses, row, k);
  }
  const struct contact_hit hit = {0.0, pack_value(contact, row, 0), pack_value(contact, row, 1),
                                  oracle_vector(normal, row)};
  const double impulse = contact_exchange(twist, &hit, mass, v);
  const char *name = part->pair.ours->name + strlen("out.");
  for (int k = 0; k < 4; k++)
    if (strcmp(name, names[k] + strlen("in.")) == 0)
      return column < 3 ? oracle_component(v[k], column) : NAN;
  return strcmp(name, "momentum") == 0 ? impulse : NAN;
}

static bool exchanges(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  if (!contact_exchange_twists[k].text)
    return false;
  relation_fill(e, exchanged, &contact_exchange_twists[k]);
  return relation_say(text, "%s", contact_exchange_twists[k].text);
}

const struct relation oracle_relations_contact[] = {
    {"crossing", "out.crosses", tests, false},
    {"crossing", "out.hit", tests, false},
    {"exchange", NULL, exchanges, true},
    {.make = NULL},
};
