#include "solvent.h"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "walls.h"
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

static CutCells cut_cells_of(const Model &model)
{
  return {model.cells[0], model.rows(), model.cells[2]};
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
    cell.resize((size_t)n);
    cell.clear();
  }
  sums.resize((size_t)(cell_count * shards));
  turn.resize((size_t)cell_count);
  sums.clear();
  if (model.thermostat != NO_THERMOSTAT) {
    relative.resize((size_t)(cell_count * shards)), total.resize(3 * (size_t)total_shards());
    relative.clear();
  }
  vertices.n = (int64_t)state.vertex.size();
  if (on_gpu)
    vertex.resize(state.vertex.size()), vertex_velocity.resize(state.vertex.size());
  else
    vertex_cell.resize(state.vertex.size());
  vertex_mass.resize(state.vertex.size());
  vertex_mass.upload(model.mass.data(), model.mass.size());
  vertices.mass = vertex_mass.data();
  if (model.flow.kind == WALLS) {
    filled.resize((size_t)cut_cells_of(model).count()), given.resize((size_t)(account_stride * shards));
    given.clear();
  }
  upload_columns(place, velocity, id, state);
  sort();
}

Columns Solvent::columns()
{
  return {place[0].data(),    place[1].data(),    place[2].data(), velocity[0].data(),
          velocity[1].data(), velocity[2].data(), id.data()};
}

Grid grid_of(const Model &model, Point shift)
{
  Point edge = model.edge();
  edge.y = model.rows() << 40;
  return {{model.cells[0], model.rows(), model.cells[2]}, edge, shift};
}

void Solvent::sort()
{
  since_sort = 0;
  count.clear();
  const Grid unshifted = grid_of(model, {0, 0, 0});
  for_each(n, CountMembers{columns(), unshifted, count.data()});
  for_each(model.rows() * model.cells[2], PlaceRows{count.data(), count.data() + cell_count, model.cells[0]});
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

// The interval that a collision ends.
static int64_t interval_of(const Model &model, uint64_t step)
{
  return (int64_t)step / model.interval - 1;
}

Image Solvent::image_at(uint64_t step, Point shift) const
{
  const Flow &flow = model.flow;
  return {shift.y, flow.offset(model.cells, model.time_step, model.interval, 2 * (int64_t)step - flow.early),
          flow.rate_during(interval_of(model, step)) * (double)model.cells[1]};
}

// Calls `use` with the border of this box: of the flight to the collision of `step`, after the last collision.
template <class Use> void Solvent::with_border(uint64_t step, Use use)
{
  const Flow &flow = model.flow;
  if (flow.kind == WALLS) {
    use(Walled{model.edge(), model.acceleration, flow.walls_at(2 * interval_of(model, step) + 1), flow.slip,
               given.data()});
  } else if (flow.kind == SHEAR) {
    Sheared border = {model.edge(), image_at(step, grid_shift(model, step)), {}, false, 0.0};
    if (last_step > 0) {
      const int64_t ended = interval_of(model, last_step);
      border.last = image_at(last_step, at_collision.shift);
      border.kicks = flow.intervals > 0;
      border.change = flow.rate_during(ended + 1) - flow.rate_during(ended);
    }
    use(border);
  } else {
    use(Periodic{model.edge()});
  }
}

void Solvent::finish_turn()
{
  if (pending)
    with_border(last_step, [&](const auto &border) {
      for_each(n, TurnSolvent<std::decay_t<decltype(border)>>{columns(), at_collision, turn.data(), model.cosine,
                                                             model.sine, border});
    });
  pending = false;
}

template <class Border> void Solvent::pass(const Border &border, double time, const Grid &next)
{
  const Flight flight = flight_of(model.acceleration, time);
  const Sums to = {sums.data(), cell_count, settings.transposed};
  const FlySum<Border> fly = {columns(), flight, border, next, to};
  const TurnFlySum<Border, true> right = {columns(),  at_collision, turn.data(), model.cosine, model.sine, flight,
                                          border, next,         to};
  const TurnFlySum<Border, false> any = {columns(),  at_collision, turn.data(), model.cosine, model.sine, flight,
                                         border, next,         to};
#ifndef __CUDACC__
  const Pass<Border> lanes_too = {columns(),  border, next, turn.data(), model.cosine,
                                  model.sine, flight, to,   cell.data()};
  const bool whole = !settings.one_by_one && suits_lanes(next);
  if (whole && pending && model.cosine == 0.0)
    pass_over<true, true>(n, lanes_too, right);
  else if (whole && pending)
    pass_over<true, false>(n, lanes_too, any);
  else if (whole)
    pass_over<false, false>(n, lanes_too, fly);
  else
#endif
      if (pending && model.cosine == 0.0)
    for_each(n, right);
  else if (pending)
    for_each(n, any);
  else
    for_each(n, fly);
}

void Solvent::fly_and_sum(uint64_t step, double time, const Grid &next)
{
  if (!settings.fused)
    finish_turn();
  if (since_sort >= settings.sort_every) {
    finish_turn();
    sort();
  }
  with_border(step, [&](const auto &border) { pass(border, time, next); });
  pending = false;
}

static Filling planar(Vector velocity, double mean)
{
  const double parts = std::ceil(mean / largest_mean);
  return {velocity, (int)parts, mean / parts, exponential(-(mean / parts))};
}

FillCell filling_of(const Model &model, const WallPair &wall, Point shift, uint64_t step)
{
  const Flow &flow = model.flow;
  const double below = (double)shift.y * lattice_unit;
  return {cut_cells_of(model), nullptr, 1, model.cell_count(), nullptr, flow.slip ? NO_FILL : flow.fill, flow.per_cell,
          {planar(wall.at[0], flow.per_cell * below), planar(wall.at[1], flow.per_cell * (1.0 - below))},
          model.source(PHANTOM_NUMBER, step), model.source(PHANTOM_VELOCITY, step)};
}

void Solvent::fill_cut_cells(uint64_t step)
{
  FillCell fill =
      filling_of(model, model.flow.walls_at(2 * interval_of(model, step) + 2), at_collision.shift, step);
  fill.sums = sums.data(), fill.shards = shards, fill.filled = filled.data();
  for_each(fill.cut.count(), fill);
}

void Solvent::solve(uint64_t step)
{
  const SolveCell body = {sums.data(), shards, cell_count, turn.data(), model.source(ROTATION_AXIS, step)};
#ifndef __CUDACC__
  if (!settings.one_by_one)
    for_each_block((cell_count + SolveBlock::size - 1) / SolveBlock::size, SolveBlock{body});
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
  for_each(vertices.n, RelativeVertex{vertices.p, vertices.v, vertices.mass, at_collision, turn.data(), to});
  if (model.thermostat == MAXWELL_BOLTZMANN) {
    for_each(cell_count, DrawFactor{turn.data(), to, shards, model.source(THERMOSTAT, step)});
    return;
  }
  if (model.thermostat == RESCALE_LAYERS) {
    for_each(model.rows(), LayerFactor{cut_cells_of(model), filled.data(), turn.data(), to, shards});
    return;
  }
  total.clear();
  for_each(cell_count, TotalRelative{turn.data(), to, shards, total.data()});
  for_each(cell_count, SetFactor{turn.data(), rescale_factor(total)});
}

// The rule at-a.
void Solvent::collide_drawn(uint64_t step)
{
  const Sums to = {sums.data(), cell_count, settings.transposed};
  const Source particle = model.source(DRAWN_PARTICLE, step), of_vertex = model.source(DRAWN_VERTEX, step);
  for_each(n, DrawSum{columns(), at_collision, to, particle});
  for_each(vertices.n, DrawSumVertex{vertices.p, vertices.v, vertices.mass, at_collision, to, of_vertex});
  solve(step);
  last_step = step;
  with_border(step, [&](const auto &border) {
    for_each(n, GiveSolvent<std::decay_t<decltype(border)>>{columns(), at_collision, turn.data(), particle, border});
  });
  for_each(vertices.n, GiveVertex{vertices.p, vertices.v, vertices.mass, at_collision, turn.data(), of_vertex});
}

// Vertices come from the host, or are there already.
void Solvent::take_vertices(State &state)
{
  if (on_gpu && vertices.n > 0) {
    vertex.upload(state.vertex.data(), state.vertex.size());
    vertex_velocity.upload(state.vertex_velocity.data(), state.vertex_velocity.size());
  }
  vertices.p = on_gpu ? vertex.data() : state.vertex.data();
  vertices.v = on_gpu ? vertex_velocity.data() : state.vertex_velocity.data();
}

void Solvent::give_vertices(State &state) const
{
  if (on_gpu && vertices.n > 0)
    vertex_velocity.download(state.vertex_velocity.data(), state.vertex_velocity.size());
}

void Solvent::sum_vertices(const Grid &next)
{
  const SumVertex body = {vertices.p, vertices.v, vertices.mass, next, {sums.data(), cell_count, 0}};
#ifndef __CUDACC__
  if (!settings.one_by_one && suits_lanes(next)) {
    over_vertices(vertices.n, SumVertices{body, vertex_cell.data(), vertices.n});
    return;
  }
#endif
  for_each(vertices.n, body);
}

void Solvent::turn_vertices()
{
  const TurnVertex body = {vertices.p, vertices.v, at_collision, turn.data(), model.cosine, model.sine};
#ifndef __CUDACC__
  if (!settings.one_by_one && suits_lanes(at_collision)) {
    over_vertices(vertices.n, TurnVertices{body, vertex_cell.data(), vertices.n});
    return;
  }
#endif
  for_each(vertices.n, body);
}

void Solvent::collide(uint64_t step, double time, State &state)
{
  const Grid next = grid_of(model, grid_shift(model, step));
  take_vertices(state);
  if (model.andersen) {
    with_border(step, [&](const auto &border) {
      for_each(n, Fly<std::decay_t<decltype(border)>>{columns(), flight_of(model.acceleration, time), border});
    });
    at_collision = next;
    collide_drawn(step);
  } else {
    if (!ahead)
      fly_and_sum(step, time, next);
    at_collision = next;
    last_step = step;
    ahead = false;
    if (model.flow.kind == WALLS)
      fill_cut_cells(step);
    sum_vertices(next);
    solve(step);
    if (model.thermostat != NO_THERMOSTAT)
      apply_thermostat(step);
    if (model.flow.kind == WALLS)
      for_each((int64_t)filled.size(), AccountCell{cut_cells_of(model), filled.data(), turn.data(), model.cosine,
                                                   model.sine, given.data()});
    pending = true;
    turn_vertices();
  }
  give_vertices(state);
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
  fly_and_sum(step, time, grid_of(model, grid_shift(model, step)));
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
  std::vector<int64_t> parts(given.size());
  given.download(parts.data(), parts.size());
  for (size_t k = 0; k < parts.size(); k += account_stride)
    for (size_t row = 0; row < 4; row++)
      state.account[row] = state.account[row] + Point{parts[k + 3 * row], parts[k + 3 * row + 1], parts[k + 3 * row + 2]};
  if (!parts.empty())
    given.clear();
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
