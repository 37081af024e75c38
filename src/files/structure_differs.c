/* Whether the particles of a file are those of a model. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "files/structure.h"

#define MASS_ROUNDING 1e-6 /* files of other programs may hold single precision */

static void tell_end(int32_t vertex, char *text, size_t size)
{
  snprintf(text, size, vertex < 0 ? "none" : "%d", (int)vertex);
}

static bool bonds_differ(const struct structure *s, const struct model *m, struct message *why)
{
  char stored[16], wanted[16];
  for (uint32_t i = 0; i < s->particles; i++) {
    const int32_t next = i < m->vertices ? m->next[i] : -1;
    if (s->next[i] == next)
      continue;
    tell_end(s->next[i], stored, sizeof stored);
    tell_end(next, wanted, sizeof wanted);
    message_set(why, "its bonds are not the scene's: vertex %u is bonded to %s in it, to %s in the scene", i, stored,
                wanted);
    return true;
  }
  if (s->bonds != m->bonds)
    message_set(why, "its bonds are not the scene's: they are %u, in the scene %u", s->bonds, m->bonds);
  return s->bonds != m->bonds;
}

bool structure_masses_differ(const double *mass, uint32_t rows, const struct model *m, struct message *why)
{
  for (uint32_t i = 0; i < rows; i++) {
    const bool vertex = i < m->vertices;
    const double wanted = vertex ? m->mass[i] : 1.0;
    if (fabs(mass[i] - wanted) <= MASS_ROUNDING * wanted)
      continue;
    message_set(why, "its masses are not the scene's: %s %u has the mass %.9g in it, %.9g in the scene",
                vertex ? "vertex" : "solvent particle", vertex ? i : i - m->vertices, mass[i], wanted);
    return true;
  }
  return false;
}

static bool is_kind(const struct model *m, const char *name)
{
  bool any = false;
  for (uint32_t k = 0; k < m->kinds; k++)
    any |= name[0] && strcmp(m->kind[k].name, name) == 0;
  return any;
}

/* Some row among the vertices has this name. */
static bool is_used(const struct structure *s, uint32_t vertices, const char *name)
{
  bool any = false;
  for (uint32_t i = 0; name[0] && !any && i < vertices; i++)
    any = strcmp(structure_name(s, s->species[i]), name) == 0;
  return any;
}

/* A name that the file and the scene have is of the same rows. Other names, and numbers, say nothing. */
static bool vertices_differ(const struct structure *s, const struct model *m, struct message *why)
{
  const uint32_t vertices = s->particles < m->vertices ? s->particles : m->vertices;
  for (uint32_t k = 0, i = 0; k < m->kinds && i < vertices; k++) {
    const char *own = m->kind[k].name;
    const bool used = is_used(s, vertices, own);
    for (const uint32_t end = i + m->kind[k].count * m->kind[k].vertices; i < end && i < vertices; i++) {
      const char *name = structure_name(s, s->species[i]);
      if (strcmp(name, own) != 0 && (used || is_kind(m, name)))
        return !message_set(why,
                            "its kinds are not the scene's: vertex %u is of '%s' in it, of '%s' in the scene; allowed: "
                            "the same, or a name that it does not have",
                            i, text_shown(name), own);
    }
  }
  return false;
}

static bool kinds_differ(const struct structure *s, const struct model *m, struct message *why)
{
  for (uint32_t i = 0; i < s->particles && s->kinds > 0; i++) {
    const char *name = structure_name(s, s->species[i]);
    if (i < m->vertices && structure_is_solvent(s, s->species[i]))
      return !message_set(why, "its rows are not in the scene's order: row %u is solvent in it, a vertex in the scene",
                          i);
    if (i >= m->vertices && is_kind(m, name) && !structure_is_solvent(s, s->species[i]))
      return !message_set(why, "its rows are not in the scene's order: row %u is of '%s' in it, solvent in the scene",
                          i, text_shown(name));
  }
  return s->kinds > 0 && vertices_differ(s, m, why);
}

bool structure_differs(const struct structure *s, const struct model *m, struct message *why)
{
  return (s->stored_bonds && bonds_differ(s, m, why)) ||
         (s->mass && structure_masses_differ(s->mass, s->particles, m, why)) || kinds_differ(s, m, why);
}

bool structure_walls_differ(bool between, const struct model *m, struct message *why)
{
  if (between != model_has_walls(m))
    message_set(why, "it is of a box %s walls, the scene's box has %s", between ? "between" : "without",
                between ? "none" : "walls");
  return between != model_has_walls(m);
}
