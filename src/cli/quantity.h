/* Physical quantities on the command line: "a0=50nm,T=300K". Units are declared once, in quantity.c. */
#ifndef UNCROSS_CLI_QUANTITY_H
#define UNCROSS_CLI_QUANTITY_H

#include <stdbool.h>
#include <stddef.h>

#include "base/message.h"

enum quantity {
  QUANTITY_LENGTH,      /* m */
  QUANTITY_TEMPERATURE, /* K */
  QUANTITY_TIME,        /* s */
  QUANTITY_MASS,        /* kg */
  QUANTITY_DENSITY,     /* kg/m^3 */
  QUANTITY_VISCOSITY,   /* Pa s */
  QUANTITY_NUMBER,
  QUANTITIES
};

/* A key of a list: its value becomes a double at `at` of a struct, in SI units. */
struct quantity_row {
  const char *key;
  enum quantity quantity;
  size_t at;
};

/* Reads "key=value,key=value" into a struct whose numbers are 0 where a key is not given. False, with a message that
 * begins with `option` and names what is allowed, if a key is unknown or comes twice, or a value is no positive number
 * with a unit of its kind. */
bool quantities_read(const char *option, const char *text, const struct quantity_row *rows, size_t count, void *into,
                     struct message *message);

/* A number for people, with a unit: four digits and an SI prefix ("50 nm") where the unit takes one, else with a power
 * of ten ("2.299e-09 m^2/s"). Returns `text`. */
const char *quantity_text(double value, const char *unit, bool takes_prefix, char *text, size_t size);

#endif
