#pragma once

#include <stdexcept>

// A run that must stop: a bond, a move or a vertex is beyond its limit.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};
