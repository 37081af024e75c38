#include "cli/sheet.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/quantity.h"

static const struct {
  const char *unit, *si;
  bool prefix; /* such as "nm"; else a power of ten */
  struct si_dimension dimension;
} units[] = {
    {"a0", "m", true, {1, 0, 0}},
    {"a0^2", "m^2", false, {2, 0, 0}},
    {"1/a0^2", "1/m^2", false, {-2, 0, 0}},
    {"1/a0^3", "1/m^3", false, {-3, 0, 0}},
    {"t0", "s", true, {0, 0, 1}},
    {"1/t0", "1/s", false, {0, 0, -1}},
    {"a0/t0", "m/s", true, {1, 0, -1}},
    {"a0/t0^2", "m/s^2", false, {1, 0, -2}},
    {"a0^2/t0", "m^2/s", false, {2, 0, -1}},
    {"kT", "J", true, {0, 1, 0}},
    {"kT/a0", "N", true, {-1, 1, 0}},
    {"kT/a0^2", "N/m", true, {-2, 1, 0}},
    {"m", "kg", false, {-2, 1, 2}},
    {"m/t0", "kg/s", false, {-2, 1, 1}},
    {"m/a0^3", "kg/m^3", false, {-5, 1, 2}},
    {"m/a0 t0", "Pa s", true, {-3, 1, 1}},
};

void sheet_heading(const char *text)
{
  printf("\n%s\n", text);
}

/* "" where there is none. */
static const char *in_si(const struct si_scale *si, double value, const char *unit, char *text, size_t size)
{
  text[0] = '\0';
  for (size_t k = 0; k < sizeof units / sizeof *units; k++)
    if (strcmp(units[k].unit, unit) == 0) {
      const double found = si_convert(si, units[k].dimension, value);
      if (isfinite(found))
        quantity_text(found, units[k].si, units[k].prefix, text, size);
    }
  return text;
}

void sheet_row(const struct si_scale *si, const char *name, const char *symbol, double value, const char *unit,
               const char *source)
{
  char text[64] = "";
  if (!isfinite(value)) /* such as a quotient by 0 */
    return;
  if (si)
    in_si(si, value, unit, text, sizeof text);
  printf("  %-38s %-9s %12.6g", name, symbol, value);
  if (*source || *text)
    printf(" %-9s", unit);
  else
    printf("%s%s", *unit ? " " : "", unit);
  if (si && *source)
    printf(" %-17s", text);
  else if (*text)
    printf(" %s", text);
  printf("%s%s\n", *source ? " " : "", source);
}
