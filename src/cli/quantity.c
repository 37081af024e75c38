#include "cli/quantity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

static const struct {
  const char *name;
  double factor;
  bool thousand; /* shown in results */
} prefixes[] = {{"z", 1e-21, true}, {"a", 1e-18, true}, {"f", 1e-15, true}, {"p", 1e-12, true}, {"n", 1e-9, true},
                {"u", 1e-6, true},  {"µ", 1e-6, false}, {"μ", 1e-6, false}, {"m", 1e-3, true},  {"c", 1e-2, false},
                {"", 1.0, true},    {"k", 1e3, true},   {"M", 1e6, true},   {"G", 1e9, true}};
enum { PREFIXES = sizeof prefixes / sizeof *prefixes };

static const struct unit {
  enum quantity quantity;
  const char *name;
  double factor;
  bool prefix; /* may stand before it */
} units[] = {
    {QUANTITY_LENGTH, "m", 1.0, true},
    {QUANTITY_TEMPERATURE, "K", 1.0, true},
    {QUANTITY_TIME, "s", 1.0, true},
    {QUANTITY_MASS, "g", 1e-3, true},
    {QUANTITY_MASS, "Da", 1.66053906660e-27, true}, /* CODATA 2018 */
    {QUANTITY_DENSITY, "kg/m^3", 1.0, false},
    {QUANTITY_DENSITY, "kg/m3", 1.0, false},
    {QUANTITY_DENSITY, "g/cm^3", 1e3, false},
    {QUANTITY_DENSITY, "g/cm3", 1e3, false},
    {QUANTITY_VISCOSITY, "Pas", 1.0, true},
    {QUANTITY_VISCOSITY, "Pa.s", 1.0, true},
    {QUANTITY_VISCOSITY, "Pa s", 1.0, true},
    {QUANTITY_VISCOSITY, "P", 0.1, true},
    {QUANTITY_NUMBER, "", 1.0, false},
};
enum { UNITS = sizeof units / sizeof *units };

static const char *const kinds[QUANTITIES] = {
    [QUANTITY_LENGTH] = "a length, such as 50nm",
    [QUANTITY_TEMPERATURE] = "a temperature, such as 300K",
    [QUANTITY_TIME] = "a time, such as 2us",
    [QUANTITY_MASS] = "a mass, such as 18Da or 3e-23kg",
    [QUANTITY_DENSITY] = "a density, such as 1000kg/m3",
    [QUANTITY_VISCOSITY] = "a viscosity, such as 1mPas",
    [QUANTITY_NUMBER] = "a number, such as 64",
};

/* The factor of a unit with its prefix; 0 if there is none of this kind. */
static double factor_of(enum quantity quantity, const char *text)
{
  for (size_t u = 0; u < UNITS; u++)
    for (size_t p = 0; p < PREFIXES; p++) {
      const size_t length = strlen(prefixes[p].name);
      if (units[u].quantity == quantity && (units[u].prefix || length == 0) &&
          strncmp(text, prefixes[p].name, length) == 0 && strcmp(text + length, units[u].name) == 0)
        return prefixes[p].factor * units[u].factor;
    }
  return 0.0;
}

/* "m, with a prefix of z a f p n u m c k M G" */
static void list_units(enum quantity quantity, char *text, size_t size)
{
  size_t used = 0;
  bool prefix = false;
  for (size_t u = 0; u < UNITS; u++)
    if (units[u].quantity == quantity && *units[u].name) {
      used += (size_t)snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "; units: ", units[u].name);
      prefix |= units[u].prefix;
    }
  if (prefix)
    used += (size_t)snprintf(text + used, size - used, ", with a prefix or none:");
  for (size_t p = 0; prefix && p < PREFIXES; p++)
    used += (size_t)snprintf(text + used, size - used, "%s%s", *prefixes[p].name ? " " : "", prefixes[p].name);
  text[used] = '\0';
}

static bool take(const char *option, const char *key, const char *value, const struct quantity_row *row, void *into,
                 struct message *message)
{
  double *place = (double *)(void *)((char *)into + row->at);
  char *end, allowed[256] = "";
  if (*place > 0.0)
    return message_set(message, "%s: %s is given twice", option, key);
  const double number = strtod(value, &end);
  const bool digits = (value[0] >= '0' && value[0] <= '9') || value[0] == '.';
  const bool hexadecimal = value[0] == '0' && (value[1] == 'x' || value[1] == 'X');
  *place = digits && !hexadecimal ? number * factor_of(row->quantity, end + strspn(end, " ")) : 0.0;
  if (*place > 0.0 && isfinite(*place))
    return true;
  *place = 0.0;
  list_units(row->quantity, allowed, sizeof allowed);
  return message_set(message, "%s: %s=%s: not %s%s", option, key, value, kinds[row->quantity], allowed);
}

static bool read_word(const char *option, char *word, const struct quantity_row *rows, size_t count, void *into,
                      struct message *message)
{
  char allowed[256] = "", *equals = strchr(word, '=');
  size_t used = 0;
  if (equals)
    *equals = '\0';
  for (size_t k = 0; k < count; k++) {
    if (equals && strcmp(word, rows[k].key) == 0)
      return take(option, word, equals + 1, &rows[k], into, message);
    used += (size_t)snprintf(allowed + used, sizeof allowed - used, "%s%s", k > 0 ? ", " : "", rows[k].key);
  }
  return message_set(message, "%s: '%s' is none of KEY=VALUE with the keys %s", option, word, allowed);
}

bool quantities_read(const char *option, const char *text, const struct quantity_row *rows, size_t count, void *into,
                     struct message *message)
{
  char *copy = strdup(text), *rest = copy;
  bool ok = copy || message_set(message, "%s: no memory", option);
  while (ok && rest) {
    char *word = rest, *comma = strchr(rest, ',');
    rest = comma ? comma + 1 : NULL;
    if (comma)
      *comma = '\0';
    ok = read_word(option, word, rows, count, into, message);
  }
  free(copy);
  return ok;
}

const char *quantity_text(double value, const char *unit, bool takes_prefix, char *text, size_t size)
{
  size_t best = PREFIXES;
  for (size_t p = 0; takes_prefix && p < PREFIXES; p++)
    if (prefixes[p].thousand && fabs(value) >= prefixes[p].factor * (1.0 - 1e-9) &&
        fabs(value) < prefixes[p].factor * 1000.0 * (1.0 - 1e-9))
      best = p;
  if (best < PREFIXES)
    snprintf(text, size, "%.5g %s%s", value / prefixes[best].factor, prefixes[best].name, unit);
  else
    snprintf(text, size, "%.5g%s%s", text_real(value), *unit ? " " : "", unit);
  return text;
}
