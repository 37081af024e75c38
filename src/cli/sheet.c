#include "cli/sheet.h"

#include <math.h>
#include <stdio.h>

void sheet_heading(const char *text)
{
  printf("\n%s\n", text);
}

void sheet_row(bool exact, const char *name, const char *symbol, double value, const char *unit, const char *source)
{
  if (!isfinite(value)) /* such as a quotient by 0 */
    return;
  if (exact)
    printf("\x1f%s\x1f%s\x1f%.17g\x1f%s\x1f%s\n", name, symbol, value, unit, source);
  else if (*source)
    printf("  %-38s %-9s %12.6g %-9s %s\n", name, symbol, value, unit, source);
  else
    printf("  %-38s %-9s %12.6g%s%s\n", name, symbol, value, *unit ? " " : "", unit);
}
