#include "model.h"

std::vector<uint32_t> permutation(const Source &source, uint32_t draw, uint32_t size)
{
  std::vector<uint32_t> order(size);
  for (uint32_t k = 0; k < size; k++)
    order[k] = k;
  __extension__ typedef unsigned __int128 Wide;
  for (uint32_t k = size; k-- > 1;) {
    const uint64_t random = integer_of(words_of(source, draw, k / 2), k % 2);
    std::swap(order[k], order[(size_t)((Wide)(k + (uint64_t)1) * random >> 64)]);
  }
  return order;
}

uint64_t state_hash(const State &state)
{
  WordHash hash;
  for (uint64_t word : {state.step, state.lag, (uint64_t)state.solvent.size(), (uint64_t)state.vertex.size()})
    hash.add(word);
  if (!state.account.empty())
    hash.add(state.account.size());
  for (size_t i = 0; i < state.solvent.size(); i++)
    hash.add(state.solvent[i]), hash.add(state.solvent_velocity[i]);
  for (size_t i = 0; i < state.vertex.size(); i++)
    hash.add(state.vertex[i]), hash.add(state.vertex_velocity[i]);
  for (const Point &row : state.account)
    hash.add(row);
  return hash.value();
}

uint64_t state_digest(const State &state)
{
  WordHash head;
  for (uint64_t word : {(uint64_t)0, state.step, state.lag, (uint64_t)state.solvent.size(), (uint64_t)state.vertex.size()})
    head.add(word);
  if (!state.account.empty())
    head.add(state.account.size());
  uint64_t sum = head.value();
  const auto add = [&](uint64_t kind, size_t number, Point p, const Vector *v) {
    WordHash row;
    row.add(kind), row.add(number), row.add(p);
    if (v)
      row.add(*v);
    sum += row.value();
  };
  for (size_t i = 0; i < state.solvent.size(); i++)
    add(1, i, state.solvent[i], &state.solvent_velocity[i]);
  for (size_t i = 0; i < state.vertex.size(); i++)
    add(2, i, state.vertex[i], &state.vertex_velocity[i]);
  for (size_t i = 0; i < state.account.size(); i++)
    add(4, i, state.account[i], nullptr);
  return sum;
}

// The cell is floor(n h / 2^24) with the high 24 bits h; the low 40 bits are the place within it.
static int64_t place_along(uint64_t integer, int64_t cells)
{
  const uint64_t h = integer >> 40, cell = (uint64_t)cells * h >> 24;
  return (int64_t)(cell << 40 | (integer & 0xffffffffff));
}

State draw_solvent(const Model &model)
{
  const int64_t n = model.particles;
  State state;
  state.solvent.resize((size_t)n);
  state.solvent_velocity.resize((size_t)n);
  const Source place = model.source(SOLVENT_POSITION, 0), velocity = model.source(SOLVENT_VELOCITY, 0);
#pragma omp parallel for
  for (int64_t i = 0; i < n; i++) {
    const uint32_t id = (uint32_t)i;
    const Words xy = words_of(place, 0, id), z = words_of(place, 1, id);
    state.solvent[(size_t)i] = {place_along(integer_of(xy, 0), model.cells[0]),
                                place_along(integer_of(xy, 1), model.cells[1]),
                                place_along(integer_of(z, 0), model.cells[2])};
    const CirclePoint a = normal_pair(words_of(velocity, 0, id)), b = normal_pair(words_of(velocity, 1, id));
    state.solvent_velocity[(size_t)i] = {a.cosine, a.sine, b.cosine};
  }
  // The total momentum is taken out, summed in the order of the ids.
  Vector momentum = {0, 0, 0};
  for (const Vector &v : state.solvent_velocity)
    momentum = momentum + v;
  const Vector change = (-1.0 / (double)n) * momentum;
#pragma omp parallel for
  for (int64_t i = 0; i < n; i++)
    state.solvent_velocity[(size_t)i] = state.solvent_velocity[(size_t)i] + change;
  return state;
}
