// Packs and starts as text: docs/port/formats.md, "Formats".
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "model.h"

struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string read_file(const std::string &path);
void write_file(const std::string &path, const std::string &text);

// One operator at one step: columns by name, such as "in.position.x".
class Group
{
public:
  bool has(const std::string &table) const;
  std::vector<int64_t> integers(const std::string &table, const std::string &name) const;
  std::vector<double> reals(const std::string &table, const std::string &name) const;
  int64_t integer(const std::string &table, const std::string &name) const;
  double real(const std::string &table, const std::string &name) const;
  std::vector<Point> points(const std::string &table) const;
  std::vector<Vector> vectors(const std::string &table, const char *x = "x", const char *y = "y",
                              const char *z = "z") const;

  std::unordered_map<std::string_view, std::vector<std::string_view>> columns;

private:
  const std::vector<std::string_view> *find(const std::string &table, const std::string &name) const;
};

struct Pack {
  explicit Pack(std::string content);
  const Group &group(const std::string &operator_name, uint64_t step) const;

  std::string text;
  std::map<std::pair<std::string_view, uint64_t>, Group> groups;
};

// The operator `model`, and of a start what it says of the run.
Model read_model(const Pack &pack);
State read_state(const Pack &pack);
