#include "pack.h"

#include <charconv>
#include <cstdio>
#include <fstream>
#include <sstream>

std::string read_file(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  if (!file)
    throw BadInput(path + ": cannot be read");
  return std::move(content).str();
}

void write_file(const std::string &path, const std::string &text)
{
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file)
    throw std::runtime_error(path + ": cannot be written");
}

// Cuts the next word off a line.
static std::string_view word(std::string_view &line)
{
  const size_t first = line.find_first_not_of(" \t\r");
  if (first == line.npos)
    return {};
  line.remove_prefix(first);
  const size_t length = std::min(line.find_first_of(" \t\r"), line.size());
  const std::string_view found = line.substr(0, length);
  line.remove_prefix(length);
  return found;
}

template <class Number> static Number number(std::string_view text)
{
  Number value{};
  const char *const end = text.data() + text.size();
  auto result = std::from_chars(text.data(), end, value);
  if constexpr (std::is_floating_point_v<Number>)
    if (text.find('x') != text.npos) { // C's %a
      const bool negative = text[0] == '-';
      result = std::from_chars(text.data() + negative + 2, end, value, std::chars_format::hex);
      value = negative ? -value : value;
    }
  if (text.empty() || result.ec != std::errc() || result.ptr != end)
    throw BadInput("'" + std::string(text) + "' is no number");
  return value;
}

Pack::Pack(std::string content) : text(std::move(content))
{
  std::string_view rest = text;
  while (!rest.empty()) {
    const size_t length = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    const std::string_view name = word(line);
    if (name.empty() || name[0] == '#')
      continue;
    const uint64_t step = number<uint64_t>(word(line));
    const size_t row = number<size_t>(word(line));
    const std::string_view column = word(line), value = word(line);
    if (value.empty() || !word(line).empty())
      throw BadInput("not a line of a pack: " + std::string(name) + " " + std::string(column));
    std::vector<std::string_view> &rows = groups[{name, step}].columns[column];
    if (row >= rows.size())
      rows.resize(row + 1);
    rows[row] = value;
  }
}

const Group &Pack::group(const std::string &operator_name, uint64_t step) const
{
  const auto found = groups.find({operator_name, step});
  if (found == groups.end())
    throw BadInput("no operator " + operator_name + " in the pack");
  return found->second;
}

const std::vector<std::string_view> *Group::find(const std::string &table, const std::string &name) const
{
  for (const std::string &full : {"in." + table + "." + name, "in." + table + ".value"}) {
    const auto found = columns.find(full);
    if (found != columns.end())
      return &found->second;
  }
  return nullptr;
}

bool Group::has(const std::string &table) const
{
  const std::string start = "in." + table + ".";
  for (const auto &column : columns)
    if (column.first.substr(0, start.size()) == start)
      return true;
  return false;
}

template <class Number> static std::vector<Number> numbers(const std::vector<std::string_view> *column)
{
  std::vector<Number> values;
  for (const std::string_view text : column ? *column : std::vector<std::string_view>{})
    values.push_back(number<Number>(text));
  return values;
}

std::vector<int64_t> Group::integers(const std::string &table, const std::string &name) const
{
  return numbers<int64_t>(find(table, name));
}

std::vector<double> Group::reals(const std::string &table, const std::string &name) const
{
  return numbers<double>(find(table, name));
}

template <class Number> static Number only(const std::vector<Number> &values, const std::string &name)
{
  if (values.size() != 1)
    throw BadInput("one value of " + name + " is needed");
  return values[0];
}

int64_t Group::integer(const std::string &table, const std::string &name) const
{
  return only(integers(table, name), table + "." + name);
}

double Group::real(const std::string &table, const std::string &name) const
{
  return only(reals(table, name), table + "." + name);
}

template <class Triple, class Number>
static std::vector<Triple> joined(const std::vector<Number> &x, const std::vector<Number> &y,
                                  const std::vector<Number> &z, const std::string &table)
{
  if (x.size() != y.size() || y.size() != z.size())
    throw BadInput("columns of " + table + " of unlike lengths");
  std::vector<Triple> rows;
  for (size_t i = 0; i < x.size(); i++)
    rows.push_back({x[i], y[i], z[i]});
  return rows;
}

std::vector<Point> Group::points(const std::string &table) const
{
  return joined<Point>(integers(table, "x"), integers(table, "y"), integers(table, "z"), table);
}

std::vector<Vector> Group::vectors(const std::string &table, const char *x, const char *y, const char *z) const
{
  return joined<Vector>(reals(table, x), reals(table, y), reals(table, z), table);
}

// A scene with a table that this port does not know is another physics: it is refused.
static void refuse_unknown(const Pack &pack)
{
  const struct {
    const char *name;
    std::vector<std::string> tables;
  } known[] = {
      {"model", {"box", "numbers", "reals", "chain", "vertex", "boundary", "flow", "wall", "wave"}},
      {"start", {"run", "counters", "rule", "collision", "switches", "solvent", "solvent_velocity", "vertex", "vertex_velocity", "account", "counts"}}};
  for (const auto &of : known)
    for (const auto &group : pack.groups) {
      if (group.first.first != of.name)
        continue;
      for (const auto &column : group.second.columns) {
        const std::string_view full = column.first;
        const std::string table(full.substr(3, full.rfind('.') - 3));
        bool found = full.substr(0, 3) != "in.";
        for (const std::string &name : of.tables)
          found = found || table == name;
        if (!found)
          throw BadInput("this port does not know the table " + table + " of " + of.name);
      }
    }
}

// The largest value of each switch that this port knows; what it does not know is another physics, too. A start of
// version 1 has none.
static void refuse_unknown_switches(const Group &start)
{
  const std::map<std::string_view, int64_t> largest = {{"version", 2},    {"crossing", 2}, {"exclusion", 1},
                                                       {"collision", 1},  {"order", 2},    {"swap", 1},
                                                       {"thermostat", RESCALE_LAYERS}, {"boundary", SHEAR}};
  const std::string_view table = "in.switches.";
  for (const auto &column : start.columns) {
    if (column.first.substr(0, table.size()) != table)
      continue;
    const std::string name(column.first.substr(table.size()));
    const auto known = largest.find(name);
    const int64_t value = start.integer("switches", name);
    if (value < 0 || value > (known == largest.end() ? 0 : known->second))
      throw BadInput("this port does not know the switch " + name + " with the value " + std::to_string(value));
  }
}

static void read_run(const Pack &pack, Model &model)
{
  refuse_unknown_switches(pack.group("start", 0));
  const Group &start = pack.group("start", 0);
  model.steps = start.integer("run", "steps");
  model.scheme = (int)start.integer("run", "scheme");
  model.thermostat = (int)start.integer("run", "thermostat");
  model.hydrodynamics = start.integer("run", "hydrodynamics") != 0;
  model.event_driven = start.has("rule") && start.integer("rule", "event_driven") == 1;
  const int64_t rule = start.has("collision") ? start.integer("collision", "rule") : 0;
  model.andersen = rule == 1;
  if (rule > 1 || model.thermostat > RESCALE_LAYERS || model.scheme > DRIFT_SPLIT)
    throw BadInput("this port has no such rule of collision, thermostat or order");
  const bool bounded = model.flow.kind != PERIODIC, walls = model.flow.kind == WALLS;
  if (model.flow.kind > SHEAR || (bounded && (!model.mass.empty() || !model.hydrodynamics)))
    throw BadInput("this port has no such boundary, and no fibers or swaps with one");
  if (walls && (model.andersen || model.thermostat == RESCALE || model.thermostat == MAXWELL_BOLTZMANN))
    throw BadInput("this port has walls with the rule srd, and without a thermostat or with rescale-layers, only");
}

static void read_flow(const Group &group, Flow &flow)
{
  if (!group.has("boundary"))
    return;
  flow.kind = (int)group.integer("boundary", "kind");
  flow.slip = group.integer("boundary", "slip") != 0;
  flow.fill = (int)group.integer("boundary", "fill");
  flow.intervals = group.integer("boundary", "intervals");
  flow.early = group.integer("boundary", "early");
  flow.per_cell = group.real("flow", "per_cell"), flow.rate = group.real("flow", "rate");
  const std::vector<Vector> wall = group.vectors("wall");
  if (flow.kind == WALLS)
    flow.wall = {{wall.at(0), wall.at(1)}};
  flow.cosine = group.reals("wave", "cosine");
  if (flow.fill > NO_FILL || flow.intervals < 0 || flow.cosine.size() != 2 * (size_t)flow.intervals)
    throw BadInput("this port has no such filling, or the wave has not two rows for each interval");
}

Model read_model(const Pack &pack)
{
  refuse_unknown(pack);
  const Group &group = pack.group("model", 0);
  Model model;
  const std::vector<Point> box = group.points("box");
  if (box.size() != 1)
    throw BadInput("one box is needed");
  model.cells[0] = box[0].x, model.cells[1] = box[0].y, model.cells[2] = box[0].z;
  model.seed = (uint64_t)group.integer("numbers", "seed_low") | (uint64_t)group.integer("numbers", "seed_high") << 32;
  model.particles = group.integer("numbers", "particles");
  model.interval = group.integer("numbers", "interval");
  model.forbidden = group.integer("numbers", "forbidden") != 0;
  model.exclusion_paper = group.integer("numbers", "exclusion_paper") != 0;
  model.time_step = group.real("reals", "time_step");
  model.cosine = group.real("reals", "cosine");
  model.sine = group.real("reals", "sine");
  model.acceleration = group.vectors("reals", "acceleration_x", "acceleration_y", "acceleration_z")[0];
  for (const int64_t j : group.integers("chain", "next"))
    model.next.push_back((int32_t)j);
  for (const int64_t j : group.integers("chain", "prev"))
    model.prev.push_back((int32_t)j);
  for (const int64_t j : group.integers("chain", "fiber"))
    model.fiber.push_back((int32_t)j);
  model.mass = group.reals("vertex", "mass");
  model.bond_length = group.reals("vertex", "bond_length");
  model.spring = group.reals("vertex", "spring");
  model.bending = group.reals("vertex", "bending");
  model.constant_force = group.vectors("vertex", "force_x", "force_y", "force_z");
  for (const size_t rows : {model.next.size(), model.prev.size(), model.fiber.size(), model.bond_length.size(),
                            model.spring.size(), model.bending.size(), model.constant_force.size()})
    if (rows != model.mass.size())
      throw BadInput("tables chain and vertex of the model of unlike lengths");
  read_flow(group, model.flow);
  if (pack.groups.count({"start", 0}))
    read_run(pack, model);
  return model;
}

State read_state(const Pack &pack)
{
  const Group &start = pack.group("start", 0);
  State state;
  state.step = (uint64_t)start.integer("counters", "step");
  state.lag = (uint64_t)start.integer("counters", "lag");
  state.solvent = start.points("solvent");
  state.solvent_velocity = start.vectors("solvent_velocity");
  state.vertex = start.points("vertex");
  state.vertex_velocity = start.vectors("vertex_velocity");
  const Group &model = pack.group("model", 0);
  if (model.has("boundary") && model.integer("boundary", "kind") == WALLS)
    state.account.assign(4, {0, 0, 0});
  if (start.has("account")) // of a checkpoint: ports/parallel/run
    state.account = start.points("account");
  if (start.has("counts"))
    state.counts = {start.integer("counts", "moves"),    start.integer("counts", "possible"),
                    start.integer("counts", "executed"), start.integer("counts", "negative"),
                    start.integer("counts", "softened"), start.integer("counts", "rigid")};
  return state;
}
