#include "solvent.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "bodies.h"
#ifndef __CUDACC__
#include "columns.h"
#endif

void upload_columns(Array<int64_t> *place, Array<double> *velocity, Array<uint32_t> &id, const State &state)
{
  const size_t n = state.solvent.size();
  std::vector<int64_t> x(n);
  std::vector<double> v(n);
  for (int axis = 0; axis < 3; axis++) {
#pragma omp parallel for
    for (int64_t i = 0; i < (int64_t)n; i++) {
      const Point &p = state.solvent[(size_t)i];
      const Vector &w = state.solvent_velocity[(size_t)i];
      x[(size_t)i] = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
      v[(size_t)i] = axis == 0 ? w.x : axis == 1 ? w.y : w.z;
    }
    place[axis].upload(x.data(), n);
    velocity[axis].upload(v.data(), n);
  }
  std::vector<uint32_t> number(n);
  for (size_t i = 0; i < n; i++)
    number[i] = (uint32_t)i;
  id.upload(number.data(), n);
}

Solvent::Solvent(const Model &model, const State &state, const Settings &settings)
    : model(model), settings(settings), n((int64_t)state.solvent.size()), cell_count(model.cell_count()),
      shards(shard_count())
{
  for (int axis = 0; axis < 3; axis++) {
    place[axis].resize((size_t)n), sorted_place[axis].resize((size_t)n);
    velocity[axis].resize((size_t)n), sorted_velocity[axis].resize((size_t)n);
  }
  id.resize((size_t)n), sorted_id.resize((size_t)n);
  count.resize((size_t)cell_count + 1);
  if (!on_gpu) {
    cell.resize((size_t)n + block_size); // some more: pass_lanes looks ahead
    cell.clear();
  }
  sums.resize((size_t)(cell_count * shards));
  turn.resize((size_t)cell_count);
  sums.clear();
  if (model.thermostat != NO_THERMOSTAT) {
    relative.resize((size_t)(cell_count * shards)), total.resize(3 * (size_t)total_shards());
    relative.clear();
  }
  vertex.resize(state.vertex.size()), vertex_velocity.resize(state.vertex.size());
  vertex_mass.resize(state.vertex.size());
  vertex_mass.upload(model.mass.data(), model.mass.size());
  upload_columns(place, velocity, id, state);
  sort();
}

Columns Solvent::columns()
{
  return {place[0].data(),    place[1].data(),    place[2].data(), velocity[0].data(),
          velocity[1].data(), velocity[2].data(), id.data()};
}

Grid Solvent::grid(Point shift) const
{
  return {{model.cells[0], model.cells[1], model.cells[2]}, model.edge(), shift};
}

void Solvent::sort()
{
  since_sort = 0;
  count.clear();
  const Grid unshifted = grid({0, 0, 0});
  for_each(n, CountMembers{columns(), unshifted, count.data()});
  for_each(model.cells[1] * model.cells[2], PlaceRows{count.data(), count.data() + cell_count, model.cells[0]});
  const Columns to = {sorted_place[0].data(),    sorted_place[1].data(),    sorted_place[2].data(),
                      sorted_velocity[0].data(), sorted_velocity[1].data(), sorted_velocity[2].data(),
                      sorted_id.data()};
  for_each(n, MoveToPlace{columns(), to, unshifted, count.data()});
  for (int axis = 0; axis < 3; axis++)
    place[axis].swap(sorted_place[axis]), velocity[axis].swap(sorted_velocity[axis]);
  id.swap(sorted_id);
}

Point grid_shift(const Model &model, uint64_t step)
{
  const Words w = words_of(model.source(GRID_SHIFT, step), 0, 0);
  return {(int64_t)w.word[0] << 8, (int64_t)w.word[1] << 8, (int64_t)w.word[2] << 8};
}

void Solvent::finish_turn()
{
  if (pending)
    for_each(n, TurnSolvent{columns(), at_collision, turn.data(), model.cosine, model.sine});
  pending = false;
}

void Solvent::fly_and_sum(double time, const Grid &next)
{
  const Flight flight = flight_of(model.acceleration, time);
  const Sums to = {sums.data(), cell_count, settings.transposed};
  if (!settings.fused)
    finish_turn();
  if (since_sort >= settings.sort_every) {
    finish_turn();
    sort();
  }
  const FlySum fly = {columns(), flight, next, to};
  const TurnFlySum<true> right = {columns(), at_collision, turn.data(), model.cosine, model.sine, flight, next, to};
  const TurnFlySum<false> any = {columns(), at_collision, turn.data(), model.cosine, model.sine, flight, next, to};
#ifndef __CUDACC__
  const Pass pass = {columns(), next, turn.data(), model.cosine, model.sine, flight, to, cell.data()};
  const bool whole = !settings.one_by_one && cell_count < INT32_MAX;
  if (whole && pending && model.cosine == 0.0)
    pass_over<true, true>(n, pass, right);
  else if (whole && pending)
    pass_over<true, false>(n, pass, any);
  else if (whole)
    pass_over<false, false>(n, pass, fly);
  else
#endif
      if (pending && model.cosine == 0.0)
    for_each(n, right);
  else if (pending)
    for_each(n, any);
  else
    for_each(n, fly);
  pending = false;
}

void Solvent::solve(uint64_t step)
{
  const SolveCell body = {sums.data(), shards, cell_count, turn.data(), model.source(ROTATION_AXIS, step)};
#ifndef __CUDACC__
  if (!settings.one_by_one)
    for_each_block((cell_count + lanes - 1) / lanes, SolveBlock{body});
  else
#endif
    for_each(cell_count, body);
}

double rescale_factor(const Array<int64_t> &total)
{
  std::vector<int64_t> parts(total.size());
  total.download(parts.data(), parts.size());
  __extension__ typedef __int128 Wide;
  Wide found = 0, wanted = 0;
  for (size_t k = 0; k < parts.size(); k += 3) {
    wanted += parts[k];
    found += ((Wide)parts[k + 1] << 32) + parts[k + 2];
  }
  return found > 0 ? std::sqrt(3.0 * (double)wanted / ((double)found * (1.0 / energy_per_unit))) : 1.0;
}

void Solvent::apply_thermostat(uint64_t step)
{
  const Relative to = {relative.data(), cell_count};
  for_each(n, RelativeSolvent{columns(), at_collision, turn.data(), to});
  for_each((int64_t)vertex.size(),
           RelativeVertex{vertex.data(), vertex_velocity.data(), vertex_mass.data(), at_collision, turn.data(), to});
  if (model.thermostat == MAXWELL_BOLTZMANN) {
    for_each(cell_count, DrawFactor{turn.data(), to, shards, model.source(THERMOSTAT, step)});
    return;
  }
  total.clear();
  for_each(cell_count, TotalRelative{turn.data(), to, shards, total.data()});
  for_each(cell_count, SetFactor{turn.data(), rescale_factor(total)});
}

// The rule at-a.
void Solvent::collide_drawn(uint64_t step, State &state)
{
  const Sums to = {sums.data(), cell_count, settings.transposed};
  const Source particle = model.source(DRAWN_PARTICLE, step), of_vertex = model.source(DRAWN_VERTEX, step);
  const int64_t vertices = (int64_t)vertex.size();
  for_each(n, DrawSum{columns(), at_collision, to, particle});
  for_each(vertices,
           DrawSumVertex{vertex.data(), vertex_velocity.data(), vertex_mass.data(), at_collision, to, of_vertex});
  solve(step);
  for_each(n, GiveSolvent{columns(), at_collision, turn.data(), particle});
  for_each(vertices,
           GiveVertex{vertex.data(), vertex_velocity.data(), vertex_mass.data(), at_collision, turn.data(), of_vertex});
  vertex_velocity.download(state.vertex_velocity.data(), state.vertex_velocity.size());
}

void Solvent::collide(uint64_t step, double time, State &state)
{
  const Grid next = grid(grid_shift(model, step));
  const int64_t vertices = (int64_t)vertex.size();
  if (vertices > 0) {
    vertex.upload(state.vertex.data(), state.vertex.size());
    vertex_velocity.upload(state.vertex_velocity.data(), state.vertex_velocity.size());
  }
  if (model.andersen) {
    for_each(n, Fly{columns(), flight_of(model.acceleration, time), next});
    at_collision = next;
    collide_drawn(step, state);
  } else {
    if (!ahead)
      fly_and_sum(time, next);
    at_collision = next;
    ahead = false;
    for_each(vertices, SumVertex{vertex.data(), vertex_velocity.data(), vertex_mass.data(), next,
                                 Sums{sums.data(), cell_count, 0}});
    solve(step);
    if (model.thermostat != NO_THERMOSTAT)
      apply_thermostat(step);
    pending = true;
    if (vertices > 0) {
      for_each(vertices,
               TurnVertex{vertex.data(), vertex_velocity.data(), next, turn.data(), model.cosine, model.sine});
      vertex_velocity.download(state.vertex_velocity.data(), state.vertex_velocity.size());
    }
  }
  since_sort++;
  if (!model.hydrodynamics) {
    finish_turn();
    swap_velocities(step);
  }
}

void Solvent::fly_ahead(uint64_t step, double time)
{
  if (model.andersen || n == 0)
    return;
  fly_and_sum(time, grid(grid_shift(model, step)));
  ahead = true;
}

void Solvent::swap_velocities(uint64_t step)
{
  std::vector<uint32_t> number((size_t)n);
  id.download(number.data(), (size_t)n);
  const std::vector<uint32_t> order = permutation(model.source(VELOCITY_SWAP, step), 0, (uint32_t)n);
  std::vector<double> old((size_t)n), by_id((size_t)n);
  for (Array<double> &column : velocity) {
    column.download(old.data(), (size_t)n);
    for (size_t i = 0; i < (size_t)n; i++)
      by_id[number[i]] = old[i];
    for (size_t i = 0; i < (size_t)n; i++)
      old[i] = by_id[order[number[i]]];
    column.upload(old.data(), (size_t)n);
  }
}

void Solvent::fetch(State &state)
{
  finish_turn();
  download_columns(place, velocity, id, state);
}

void download_columns(const Array<int64_t> *place, const Array<double> *velocity, const Array<uint32_t> &id,
                      State &state)
{
  const size_t n = state.solvent.size();
  std::vector<uint32_t> number(n);
  id.download(number.data(), n);
  std::vector<int64_t> x(n);
  std::vector<double> v(n);
  for (int axis = 0; axis < 3; axis++) {
    place[axis].download(x.data(), n);
    velocity[axis].download(v.data(), n);
#pragma omp parallel for
    for (int64_t i = 0; i < (int64_t)n; i++) {
      const size_t at = (size_t)i, to = number[at];
      Point &p = state.solvent[to];
      Vector &w = state.solvent_velocity[to];
      (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = x[at];
      (axis == 0 ? w.x : axis == 1 ? w.y : w.z) = v[at];
    }
  }
}
