// Operators of the solvent: the bodies of the loops of a step, each alone.
#include "operators_parts.h"

#include "walls.h"

// A place within each of these cells of the grid without a shift.
static std::vector<Point> places_in(const Model &model, const std::vector<int64_t> &cells)
{
  std::vector<Point> places;
  for (const int64_t cell : cells) {
    if (cell < 0 || cell >= model.cell_count())
      throw BadInput("there is no cell " + std::to_string(cell));
    const int64_t row = cell / model.cells[0];
    places.push_back({(cell % model.cells[0]) << 40, (row % model.rows()) << 40, (row / model.rows()) << 40});
  }
  return places;
}

static Members members_of(const OperatorInput &in)
{
  State state;
  state.solvent = places_in(in.model, in.group.integers("solvent_cell", "cell"));
  state.vertex = places_in(in.model, in.group.integers("vertex_cell", "cell"));
  state.solvent_velocity = in.group.vectors("solvent"), state.vertex_velocity = in.group.vectors("vertex");
  if (state.solvent.size() != state.solvent_velocity.size() || state.vertex.size() != state.vertex_velocity.size())
    throw BadInput("as many cells as velocities are needed");
  return {in.model, std::move(state)};
}

static void stream(const OperatorInput &in, Writer &out)
{
  State state;
  state.solvent = in.group.points("position"), state.solvent_velocity = in.group.vectors("velocity");
  Members members(in.model, std::move(state));
  const Flight flight = flight_of(in.model.acceleration, in.group.real("time", "dt"));
  for_each(members.n, Fly<Periodic>{members.columns(), flight, {in.model.edge()}});
  members.fetch();
  out.triples("position", members.state.solvent), out.triples("velocity", members.state.solvent_velocity);
}

static void shift(const OperatorInput &in, Writer &out)
{
  out.triple(0, "shift", grid_shift(in.model, in.step));
}

static void bin(const OperatorInput &in, Writer &out)
{
  const Grid grid = grid_of(in.model, in.group.points("shift").at(0));
  for (const char *table : {"solvent", "vertex"}) {
    std::vector<int64_t> cells;
    for (const Point &p : in.group.points(table))
      cells.push_back(cell_of(grid, p));
    out.column(table, "cell", cells);
  }
}

static void sum(const OperatorInput &in, Writer &out)
{
  Members members = members_of(in);
  const int64_t cells = members.cell_count;
  const int shards = shard_count();
  Array<CellSum> sums((size_t)(cells * shards));
  sums.clear();
  const Grid grid = grid_of(in.model, {0, 0, 0});
  const Periodic all = {grid.edge};
  for_each(members.n,
           FlySum<Periodic>{members.columns(), flight_of({0, 0, 0}, 0.0), all, grid, Sums{sums.data(), cells, 1}});
  for_each(members.vertices, SumVertex{members.vertex.data(), members.vertex_velocity.data(), members.mass.data(), grid,
                                       Sums{sums.data(), cells, 0}});
  std::vector<CellSum> found(sums.size());
  sums.download(found.data(), found.size());
  for (size_t part = (size_t)cells; part < found.size(); part++) {
    CellSum &s = found[part % (size_t)cells];
    const CellSum &each = found[part];
    s = {s.x + each.x, s.y + each.y, s.z + each.z, s.load + each.load};
  }
  found.resize((size_t)cells);
  write_sums(out, found);
}

void write_sums(Writer &out, const std::vector<CellSum> &sums)
{
  for (size_t cell = 0; cell < sums.size(); cell++) {
    const CellSum &s = sums[cell];
    out.triple(cell, "momentum", Point{s.x, s.y, s.z});
    out.value(cell, "load", "members", s.load >> load_bits);
    out.value(cell, "load", "mass", s.load & (((int64_t)1 << load_bits) - 1));
  }
}

template <bool with_axes> static void solve(const OperatorInput &in, Writer &out)
{
  const std::vector<int64_t> members = in.group.integers("load", "members"), mass = in.group.integers("load", "mass");
  const std::vector<Point> momentum = in.group.points("momentum");
  std::vector<CellSum> given;
  for (size_t cell = 0; cell < members.size(); cell++)
    given.push_back({momentum[cell].x, momentum[cell].y, momentum[cell].z, (members[cell] << load_bits) + mass[cell]});
  const int64_t count = (int64_t)given.size();
  Array<CellSum> sums(given.size());
  Array<CellTurn> turn(given.size());
  sums.upload(given.data(), given.size());
  for_each(count, SolveCell{sums.data(), 1, count, turn.data(), in.model.source(ROTATION_AXIS, in.step)});
  std::vector<CellTurn> found(given.size());
  turn.download(found.data(), found.size());
  for (size_t cell = 0; cell < found.size(); cell++) {
    const bool active = found[cell].active != 0;
    out.value(cell, "active", "active", (int64_t)active);
    out.triple(cell, "center", active ? found[cell].center : Vector{0, 0, 0});
    if (with_axes)
      out.triple(cell, "axis", active ? found[cell].axis : Vector{0, 0, 0});
  }
}

static void draw(const OperatorInput &in, Writer &out)
{
  const Source particle = in.model.source(DRAWN_PARTICLE, in.step), vertex = in.model.source(DRAWN_VERTEX, in.step);
  for (uint32_t k = 0; k < (uint32_t)in.model.particles; k++)
    out.triple(k, "solvent", drawn(particle, k));
  for (uint32_t k = 0; k < (uint32_t)in.model.vertices(); k++)
    out.triple(k, "vertex", drawn(vertex, k, in.model.mass[k]));
}

template <int kind> static void thermostat(const OperatorInput &in, Writer &out)
{
  Members members = members_of(in);
  const int64_t cells = members.cell_count;
  const int shards = shard_count();
  const std::vector<int64_t> number = in.group.integers("load", "members");
  const std::vector<Vector> center = in.group.vectors("center");
  std::vector<CellTurn> given;
  for (size_t cell = 0; cell < (size_t)cells; cell++)
    given.push_back({center[cell], {0, 0, 0}, 1.0, number[cell] > 1 ? number[cell] : 0});
  Array<CellTurn> turn(given.size());
  turn.upload(given.data(), given.size());
  Array<int64_t> relative((size_t)(cells * shards)), total(3 * (size_t)total_shards());
  relative.clear(), total.clear();
  const Relative to = {relative.data(), cells};
  const Grid grid = grid_of(in.model, {0, 0, 0});
  for_each(members.n, RelativeSolvent{members.columns(), grid, turn.data(), to});
  for_each(members.vertices, RelativeVertex{members.vertex.data(), members.vertex_velocity.data(), members.mass.data(),
                                            grid, turn.data(), to});
  std::vector<int64_t> parts(relative.size()), energy((size_t)cells, 0);
  relative.download(parts.data(), parts.size());
  for (size_t k = 0; k < parts.size(); k++)
    energy[k % (size_t)cells] += parts[k];
  if (kind == MAXWELL_BOLTZMANN) {
    for_each(cells, DrawFactor{turn.data(), to, shards, in.model.source(THERMOSTAT, in.step)});
  } else if (kind == RESCALE_LAYERS) {
    const std::vector<Virtual> numbers = filled_of(in);
    Array<Virtual> filled(numbers.size());
    filled.upload(numbers.data(), numbers.size());
    const CutCells cut = {in.model.cells[0], in.model.rows(), in.model.cells[2]};
    for_each(in.model.rows(), LayerFactor{cut, filled.data(), turn.data(), to, shards});
  } else {
    for_each(cells, TotalRelative{turn.data(), to, shards, total.data()});
    for_each(cells, SetFactor{turn.data(), rescale_factor(total)});
  }
  turn.download(given.data(), given.size());
  out.column("relative", "energy", energy);
  for (size_t cell = 0; cell < (size_t)cells; cell++)
    out.value(cell, "factor", "factor", given[cell].active ? given[cell].factor : 1.0);
}

std::vector<CellTurn> turns_of(const OperatorInput &in)
{
  const std::vector<int64_t> active = in.group.integers("active", "active");
  const std::vector<Vector> center = in.group.vectors("center"), axis = in.group.vectors("axis");
  const std::vector<double> factor = in.group.reals("factor", "factor");
  std::vector<CellTurn> turns;
  for (size_t cell = 0; cell < active.size(); cell++)
    turns.push_back({center[cell], axis[cell], factor[cell], active[cell]});
  return turns;
}

std::vector<Virtual> filled_of(const OperatorInput &in)
{
  const std::vector<double> number = in.group.reals("filled", "number");
  const std::vector<Vector> velocity = in.group.vectors("filled");
  std::vector<Virtual> filled;
  for (size_t k = 0; k < number.size(); k++)
    filled.push_back({number[k], velocity[k]});
  return filled;
}

static void rotate(const OperatorInput &in, Writer &out)
{
  Members members = members_of(in);
  const std::vector<CellTurn> given = turns_of(in);
  Array<CellTurn> turn(given.size());
  turn.upload(given.data(), given.size());
  const Grid grid = grid_of(in.model, {0, 0, 0});
  const double cosine = in.model.cosine, sine = in.model.sine;
  for_each(members.n, TurnSolvent<Periodic>{members.columns(), grid, turn.data(), cosine, sine, {in.model.edge()}});
  for_each(members.vertices,
           TurnVertex{members.vertex.data(), members.vertex_velocity.data(), grid, turn.data(), cosine, sine});
  members.fetch();
  out.triples("solvent", members.state.solvent_velocity), out.triples("vertex", members.state.vertex_velocity);
}

static void give(const OperatorInput &in, Writer &out)
{
  const std::vector<int64_t> active = in.group.integers("active", "active");
  const std::vector<Vector> center = in.group.vectors("center");
  for (const std::string table : {"solvent", "vertex"}) {
    std::vector<Vector> velocity = in.group.vectors(table);
    const std::vector<int64_t> cells = in.group.integers(table + "_cell", "cell");
    const std::vector<Vector> its = in.group.vectors(table + "_drawn");
    for (size_t k = 0; k < velocity.size(); k++)
      if (active[(size_t)cells[k]])
        velocity[k] = center[(size_t)cells[k]] + its[k];
    out.triples(table.c_str(), velocity);
  }
}

static void swap(const OperatorInput &in, Writer &out)
{
  const std::vector<Vector> old = in.group.vectors("velocity");
  const std::vector<uint32_t> order = permutation(in.model.source(VELOCITY_SWAP, in.step), 0, (uint32_t)old.size());
  for (size_t k = 0; k < old.size(); k++) {
    out.value(k, "order", "particle", (int64_t)order[k]);
    out.triple(k, "velocity", old[order[k]]);
  }
}

Operator solvent_operator(std::string_view name)
{
  static const NamedOperator known[] = {{"stream", stream},
               {"shift", shift},
               {"bin", bin},
               {"sum", sum},
               {"solve", solve<true>},
               {"mean", solve<false>},
               {"draw", draw},
               {"rescale", thermostat<RESCALE>},
               {"maxwell_boltzmann", thermostat<MAXWELL_BOLTZMANN>},
               {"rescale_layers", thermostat<RESCALE_LAYERS>},
               {"rotate", rotate},
               {"give", give},
               {"swap", swap}};
  return operator_among(known, name);
}
