/* Lines of `uncross check`: a number in units a0, kT, m, and beside it in SI units if they are asked for. */
#ifndef UNCROSS_CLI_SHEET_H
#define UNCROSS_CLI_SHEET_H

#include "theory/si.h"

void sheet_heading(const char *text);

/* Name, symbol, value, unit ("a0^2/t0"; "": a pure number), and where the number comes from. si: NULL without SI units;
 * a unit must stand in the table of sheet.c, or no SI value is shown. */
void sheet_row(const struct si_scale *si, const char *name, const char *symbol, double value, const char *unit,
               const char *source);

#endif
