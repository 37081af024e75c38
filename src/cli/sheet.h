/* Lines of `uncross check`: a number in units a0, kT, m. */
#ifndef UNCROSS_CLI_SHEET_H
#define UNCROSS_CLI_SHEET_H

#include <stdbool.h>

void sheet_heading(const char *text);

/* Name, symbol, value, unit ("a0^2/t0"; "": a pure number), and where the number comes from. exact: all digits, for
 * programs, with a byte 0x1f before each part, which no other line of a report holds. */
void sheet_row(bool exact, const char *name, const char *symbol, double value, const char *unit, const char *source);

#endif
