/* Searches and impulses of contacts at their own time, made with one thing changed. */
#include <math.h>
#include <string.h>

#include "oracle/event_model.h"
#include "oracle/patterns.h"
#include "oracle/relations.h"

static const struct pack_table *input_of(const struct evidence_part *part, const char *name)
{
  return oracle_sibling(&part->pair, name);
}

static bool point_of(const struct evidence_part *part, const char *name, uint32_t row, struct point *p)
{
  const struct pack_table *t = input_of(part, name);
  const bool ok = oracle_is_vectors(t, false, row);
  if (ok)
    *p = oracle_point(t, row);
  return ok;
}

static double searched(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *from = input_of(part, "in.from");
  struct flight_pair f;
  (void)column;
  if (!from || !point_of(part, "in.p", row, &f.p) || !point_of(part, "in.q", row, &f.q) ||
      !point_of(part, "in.w", row, &f.w) || !point_of(part, "in.p_rate", row, &f.p_rate) ||
      !point_of(part, "in.q_rate", row, &f.q_rate) || !point_of(part, "in.w_rate", row, &f.w_rate) ||
      !oracle_search_is_legal(&f, pack_value(from, row, 0)))
    return NAN;
  return event_search(twist, &f, (int32_t)pack_value(from, row, 0));
}

static bool searches(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  if (!event_search_twists[k].text)
    return false;
  relation_fill(e, searched, &event_search_twists[k]);
  return relation_say(text, "%s", event_search_twists[k].text);
}

static bool take_ends(const struct evidence_part *part, uint32_t row, struct oracle_impulse *e)
{
  const struct pack_table *mass = input_of(part, "in.mass");
  for (uint32_t k = 0; k < 4; k++) {
    char name[2][PACK_WORD];
    snprintf(name[0], sizeof name[0], "in.%s", oracle_ends[k]);
    snprintf(name[1], sizeof name[1], "in.force_%s", oracle_ends[k]);
    const struct pack_table *v = input_of(part, name[0]), *f = input_of(part, name[1]);
    if (!mass || !oracle_is_vectors(v, true, row) || !oracle_is_vectors(f, true, row))
      return false;
    e->velocity[k] = oracle_vector(v, row), e->force[k] = oracle_vector(f, row);
    e->mass[k] = pack_value(mass, row, k);
  }
  return true;
}

static double exchanged(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *contact = input_of(part, "in.contact"), *normal = input_of(part, "in.normal"),
                          *tau = input_of(part, "in.tau");
  struct oracle_impulse e;
  enum contact_answer answer;
  if (!contact || !tau || !oracle_is_vectors(normal, true, row) || !take_ends(part, row, &e))
    return NAN;
  e.s = pack_value(contact, row, 0), e.t = pack_value(contact, row, 1), e.tau = pack_value(tau, row, 0);
  e.normal = oracle_vector(normal, row);
  const double impulse = event_impulse(twist, &e, &answer);
  const char *name = part->pair.ours->name + strlen("out.");
  for (int k = 0; k < 4; k++)
    if (strcmp(name, oracle_ends[k]) == 0)
      return column < 3 ? oracle_component(e.velocity[k], column) : NAN;
  return strcmp(name, "momentum") == 0 ? impulse : strcmp(name, "answer") == 0 ? (double)answer : NAN;
}

static bool impulses(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  const struct event_twist *t = &event_impulse_twists[k];
  if (!t->text)
    return false;
  relation_fill(e, exchanged, t);
  return relation_say(text, "%s", t->text);
}

const struct relation oracle_relations_event[] = {
    {"contact_search", "out.tick", searches, .together = false},
    {"impulse", NULL, impulses, .together = true}, /* many bugs make the same answers */
    {.make = NULL},
};
