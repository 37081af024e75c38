// Operators of walls and shear: docs/port/operators.md, "Walls and shear".
#include <array>

#include "operators_parts.h"
#include "walls.h"

static State particles_of(const OperatorInput &in)
{
  State state;
  state.solvent = in.group.points("position"), state.solvent_velocity = in.group.vectors("velocity");
  return state;
}

static WallPair walls_of(const OperatorInput &in)
{
  const std::vector<Vector> wall = in.group.vectors("wall");
  return {{wall.at(0), wall.at(1)}};
}

// The image's offset and speed of `in`, and the shift of the grid if there is one.
static Image image_of(const OperatorInput &in)
{
  return {in.group.has("shift") ? in.group.points("shift").at(0).y : 0, in.group.integer("offset", "offset"),
          in.group.real("speed", "speed")};
}

static void write_wall(Writer &out, const char *table, size_t row, const WallPair &wall)
{
  static const char *const name[] = {"lower_x", "lower_y", "lower_z", "upper_x", "upper_y", "upper_z"};
  const Vector &a = wall.at[0], &b = wall.at[1];
  const std::array<double, 6> value = {a.x, a.y, a.z, b.x, b.y, b.z};
  for (size_t k = 0; k < value.size(); k++)
    out.value(row, table, name[k], value[k]);
}

// The rows of one account, by hits or by collisions, of all threads.
static void write_given(Writer &out, const Array<int64_t> &given, size_t first)
{
  std::vector<int64_t> parts(given.size());
  given.download(parts.data(), parts.size());
  for (size_t wall = 0; wall < 2; wall++) {
    Point sum = {0, 0, 0};
    for (size_t k = first + 3 * wall; k < parts.size(); k += account_stride)
      sum = sum + Point{parts[k], parts[k + 1], parts[k + 2]};
    out.triple(wall, "given", sum);
  }
}

static void wall_motion(const OperatorInput &in, Writer &out)
{
  const std::vector<int64_t> interval = in.group.integers("interval", "interval");
  for (size_t row = 0; row < interval.size(); row++) {
    write_wall(out, "flight", row, in.model.flow.walls_at(2 * interval[row] + 1));
    write_wall(out, "end", row, in.model.flow.walls_at(2 * interval[row] + 2));
  }
}

static void shear_motion(const OperatorInput &in, Writer &out)
{
  const Model &model = in.model;
  const std::vector<int64_t> interval = in.group.integers("interval", "interval"),
                             time = in.group.integers("half_steps", "half_steps");
  for (size_t row = 0; row < interval.size(); row++) {
    out.value(row, "rate", "rate", model.flow.rate_during(interval[row]));
    out.value(row, "offset", "offset",
              model.flow.offset(model.cells, model.time_step, model.interval, time.at(row)));
  }
}

static void wall_stream(const OperatorInput &in, Writer &out)
{
  Members members(in.model, particles_of(in));
  Array<int64_t> given((size_t)(account_stride * shard_count()));
  given.clear();
  const Walled border = {in.model.edge(), in.model.acceleration, walls_of(in), in.model.flow.slip, given.data()};
  for_each(members.n, Fly<Walled>{members.columns(), flight_of(in.model.acceleration, in.group.real("time", "dt")), border});
  members.fetch();
  out.triples("position", members.state.solvent), out.triples("velocity", members.state.solvent_velocity);
  write_given(out, given, 0);
}

static void wall_bin(const OperatorInput &in, Writer &out)
{
  const Grid grid = grid_of(in.model, in.group.points("shift").at(0));
  std::vector<int64_t> cells;
  for (const Point &p : in.group.points("solvent"))
    cells.push_back(cell_of(grid, p));
  out.column("solvent", "cell", cells);
}

static void fill(const OperatorInput &in, Writer &out)
{
  const std::vector<int64_t> members = in.group.integers("load", "members"), mass = in.group.integers("load", "mass");
  const std::vector<Point> momentum = in.group.points("momentum");
  std::vector<CellSum> cells;
  for (size_t k = 0; k < members.size(); k++)
    cells.push_back({momentum[k].x, momentum[k].y, momentum[k].z, (members[k] << load_bits) + mass[k]});
  FillCell body = filling_of(in.model, walls_of(in), in.group.points("shift").at(0), in.step);
  const size_t cut = (size_t)body.cut.count();
  Array<CellSum> sums(cells.size());
  Array<Virtual> filled(cut);
  sums.upload(cells.data(), cells.size());
  body.sums = sums.data(), body.filled = filled.data();
  for_each((int64_t)cut, body);
  sums.download(cells.data(), cells.size());
  std::vector<Virtual> found(cut);
  filled.download(found.data(), cut);
  for (size_t k = 0; k < cut; k++) {
    out.value(k, "filled", "number", found[k].number);
    out.triple(k, "filled", found[k].velocity);
  }
  write_sums(out, cells);
}

static void account(const OperatorInput &in, Writer &out)
{
  const std::vector<CellTurn> cells = turns_of(in);
  const std::vector<Virtual> virtual_ones = filled_of(in);
  Array<CellTurn> turn(cells.size());
  Array<Virtual> filled(virtual_ones.size());
  Array<int64_t> given((size_t)(account_stride * shard_count()));
  turn.upload(cells.data(), cells.size()), filled.upload(virtual_ones.data(), virtual_ones.size());
  given.clear();
  const CutCells cut = {in.model.cells[0], in.model.rows(), in.model.cells[2]};
  for_each(cut.count(),
           AccountCell{cut, filled.data(), turn.data(), in.model.cosine, in.model.sine, given.data()});
  write_given(out, given, 6);
}

static void shear_stream(const OperatorInput &in, Writer &out)
{
  State state = particles_of(in);
  const Sheared border = {in.model.edge(), image_of(in), {}, false, 0.0};
  const Flight flight = flight_of(in.model.acceleration, in.group.real("time", "dt"));
  for (size_t k = 0; k < state.solvent.size(); k++)
    border.fly(flight, state.solvent[k], state.solvent_velocity[k], 0);
  out.triples("position", state.solvent), out.triples("velocity", state.solvent_velocity);
}

template <bool enters> static void change_image(const OperatorInput &in, Writer &out)
{
  State state = particles_of(in);
  const Sheared border = {in.model.edge(), image_of(in), image_of(in), false, 0.0};
  for (size_t k = 0; k < state.solvent.size(); k++)
    enters ? border.enter(state.solvent[k], state.solvent_velocity[k])
           : border.leave(state.solvent[k], state.solvent_velocity[k]);
  out.triples("position", state.solvent), out.triples("velocity", state.solvent_velocity);
}

static void affine_kick(const OperatorInput &in, Writer &out)
{
  State state = particles_of(in);
  // No particle is an image.
  const Sheared border = {in.model.edge(), {}, {}, true, in.group.real("change", "rate")};
  for (size_t k = 0; k < state.solvent.size(); k++)
    border.leave(state.solvent[k], state.solvent_velocity[k]);
  out.triples("velocity", state.solvent_velocity);
}

Operator flow_operator(std::string_view name)
{
  static const NamedOperator known[] = {{"wall_motion", wall_motion},
               {"shear_motion", shear_motion},
               {"wall_stream", wall_stream},
               {"wall_bin", wall_bin},
               {"fill", fill},
               {"account", account},
               {"shear_stream", shear_stream},
               {"enter", change_image<true>},
               {"leave", change_image<false>},
               {"affine_kick", affine_kick}};
  return operator_among(known, name);
}
