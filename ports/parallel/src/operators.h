// Operators of packs: docs/port/operators.md, "The operators".
#pragma once

#include "pack.h"

// Outputs of all operators of a pack, as text. Throws BadInput at one that this port does not have.
std::string operators_of(const Pack &pack);

// Lines of one operator's outputs.
struct Writer {
  std::string &text;
  std::string head; // "kick 2 "

  void value(size_t row, const char *table, const char *name, double value);
  void value(size_t row, const char *table, const char *name, int64_t value);
  void triple(size_t row, const char *table, Vector v);
  void triple(size_t row, const char *table, Point p);
  template <class Number> void column(const char *table, const char *name, const std::vector<Number> &values)
  {
    for (size_t row = 0; row < values.size(); row++)
      value(row, table, name, values[row]);
  }
  template <class Triple> void triples(const char *table, const std::vector<Triple> &values)
  {
    for (size_t row = 0; row < values.size(); row++)
      triple(row, table, values[row]);
  }
};

struct OperatorInput {
  const Model &model;
  const Group &group;
  uint64_t step;
};

using Operator = void (*)(const OperatorInput &in, Writer &out);
struct NamedOperator {
  std::string_view name;
  Operator function;
};
// Null if there is none of this name.
template <size_t n> Operator operator_among(const NamedOperator (&known)[n], std::string_view name)
{
  for (const NamedOperator &each : known)
    if (each.name == name)
      return each.function;
  return nullptr;
}
// Of the solvent; of walls and shear. Null if there is none of this name.
Operator solvent_operator(std::string_view name);
Operator flow_operator(std::string_view name);
