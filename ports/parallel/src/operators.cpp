#include "operators.h"

#include <cinttypes>

#include "events.h"
#include "solvent.h"
#include "sweep.h"

void Writer::value(size_t row, const char *table, const char *name, double value)
{
  char line[160];
  std::snprintf(line, sizeof line, "%zu out.%s.%s %a\n", row, table, name, value);
  text += head + line;
}

void Writer::value(size_t row, const char *table, const char *name, int64_t value)
{
  char line[160];
  std::snprintf(line, sizeof line, "%zu out.%s.%s %" PRId64 "\n", row, table, name, value);
  text += head + line;
}

void Writer::triple(size_t row, const char *table, Vector v)
{
  value(row, table, "x", v.x), value(row, table, "y", v.y), value(row, table, "z", v.z);
}

void Writer::triple(size_t row, const char *table, Point p)
{
  value(row, table, "x", p.x), value(row, table, "y", p.y), value(row, table, "z", p.z);
}

static std::vector<int64_t> wide(const std::vector<uint32_t> &order)
{
  return {order.begin(), order.end()};
}

/* --- random numbers --------------------------------------------------------------------------------------------- */

static void random_numbers(const OperatorInput &in, Writer &out)
{
  const auto column = [&](const char *name) { return in.group.integers("address", name); };
  const std::vector<int64_t> purpose = column("purpose"), draw = column("draw"), step = column("step"),
                             entity = column("entity");
  static const char *const number[] = {"0", "1", "2", "3"};
  for (size_t row = 0; row < purpose.size(); row++) {
    const Source source = in.model.source((uint32_t)purpose[row], (uint64_t)step[row]);
    const Words words = words_of(source, (uint32_t)draw[row], (uint32_t)entity[row]);
    for (int k = 0; k < 4; k++)
      out.value(row, "word", number[k], (int64_t)words.word[k]);
    for (int k = 0; k < 2; k++)
      out.value(row, "uniform", number[k], uniform_of(words, k));
    const CirclePoint pair = normal_pair(words);
    out.value(row, "normal", "first", pair.cosine), out.value(row, "normal", "second", pair.sine);
    out.triple(row, "axis", axis_of(source, (uint32_t)entity[row]));
  }
}

static void any_permutation(const OperatorInput &in, Writer &out)
{
  const auto value = [&](const char *name) { return in.group.integer("address", name); };
  const Source source = in.model.source((uint32_t)value("purpose"), (uint64_t)value("step"));
  out.column("order", "entry", wide(permutation(source, (uint32_t)value("draw"), (uint32_t)value("size"))));
}

static void order_of_vertices(const OperatorInput &in, Writer &out)
{
  const Source source = in.model.source(VERTEX_ORDER, in.step);
  out.column("order", "vertex", wide(permutation(source, 0, (uint32_t)in.model.vertices())));
}

/* --- the rule sequential ---------------------------------------------------------------------------------------- */

static void write_hit(Writer &out, size_t row, const CrossingHit &hit)
{
  out.value(row, "hit", "time", hit.time), out.value(row, "hit", "s", hit.s);
  out.value(row, "hit", "s_standing", hit.s_standing), out.value(row, "hit", "normal_x", hit.normal.x);
  out.value(row, "hit", "normal_y", hit.normal.y), out.value(row, "hit", "normal_z", hit.normal.z);
}

static void crossing(const OperatorInput &in, Writer &out)
{
  const Group &g = in.group;
  const std::vector<Point> from = g.points("from"), to = g.points("to"), pivot = g.points("pivot"), a = g.points("a"),
                           b = g.points("b");
  const std::vector<int64_t> flip = g.integers("flip", "flip");
  for (size_t row = 0; row < from.size(); row++) {
    CrossingHit hit;
    const bool found = crosses({from[row], to[row], pivot[row], a[row], b[row], flip[row] != 0}, hit);
    out.value(row, "crosses", "crosses", (int64_t)found);
    write_hit(out, row, hit);
  }
}

static void exchange(const OperatorInput &in, Writer &out)
{
  static const char *const four[] = {"moving", "pivot", "a", "b"};
  std::vector<Vector> velocity[4];
  std::vector<double> mass[4];
  for (int k = 0; k < 4; k++)
    velocity[k] = in.group.vectors(four[k]), mass[k] = in.group.reals("mass", four[k]);
  const std::vector<double> s = in.group.reals("contact", "s"), standing = in.group.reals("contact", "s_standing");
  const std::vector<Vector> normal = in.group.vectors("normal");
  for (size_t row = 0; row < s.size(); row++) {
    Vector v[4];
    double m[4];
    for (int k = 0; k < 4; k++)
      v[k] = velocity[k][row], m[k] = mass[k][row];
    out.value(row, "momentum", "momentum", exchange_momentum(v, m, s[row], standing[row], normal[row]));
    for (int k = 0; k < 4; k++)
      out.triple(row, four[k], v[k]);
  }
}

static void sweep(const OperatorInput &in, Writer &out)
{
  std::vector<Point> position = in.group.points("position");
  std::vector<Vector> velocity = in.group.vectors("velocity");
  std::vector<uint32_t> order;
  for (const int64_t vertex : in.group.integers("order", "vertex"))
    order.push_back((uint32_t)vertex);
  std::vector<SweepRow> rows;
  Sweep(in.model).move(in.group.real("time", "dt"), order, position, velocity, &rows);
  for (size_t k = 0; k < rows.size(); k++) {
    const SweepRow &row = rows[k];
    out.value(k, "event", "vertex", (int64_t)row.vertex), out.value(k, "event", "moving", (int64_t)row.moving);
    out.value(k, "event", "standing", (int64_t)row.standing);
    out.value(k, "event", "image_x", (int64_t)row.image[0]), out.value(k, "event", "image_y", (int64_t)row.image[1]);
    out.value(k, "event", "image_z", (int64_t)row.image[2]), out.value(k, "event", "executed", (int64_t)row.executed);
    write_hit(out, k, row.hit);
    out.value(k, "hit", "momentum", row.momentum);
  }
  out.triples("position", position), out.triples("velocity", velocity);
}

/* --- the rule event-driven -------------------------------------------------------------------------------------- */

static void contact_search(const OperatorInput &in, Writer &out)
{
  const Group &g = in.group;
  const std::vector<Point> p = g.points("p"), q = g.points("q"), w = g.points("w"), p_rate = g.points("p_rate"),
                           q_rate = g.points("q_rate"), w_rate = g.points("w_rate");
  const std::vector<int64_t> from = g.integers("from", "tick");
  for (size_t row = 0; row < from.size(); row++)
    out.value(row, "tick", "tick",
              first_contact({p[row], q[row], w[row], p_rate[row], q_rate[row], w_rate[row]}, from[row]));
}

static void impulses(const OperatorInput &in, Writer &out)
{
  static const char *const end[] = {"p0", "p1", "q0", "q1"};
  std::vector<Vector> velocity[4], force[4];
  std::vector<double> mass[4];
  for (int k = 0; k < 4; k++) {
    velocity[k] = in.group.vectors(end[k]), mass[k] = in.group.reals("mass", end[k]);
    force[k] = in.group.vectors(std::string("force_") + end[k]);
  }
  const std::vector<double> s = in.group.reals("contact", "s"), t = in.group.reals("contact", "t"),
                            tau = in.group.reals("tau", "tau");
  const std::vector<Vector> normal = in.group.vectors("normal");
  for (size_t row = 0; row < s.size(); row++) {
    Ends ends;
    for (int k = 0; k < 4; k++)
      ends.velocity[k] = velocity[k][row], ends.force[k] = force[k][row], ends.mass[k] = mass[k][row];
    double momentum;
    out.value(row, "answer", "answer", (int64_t)impulse(ends, {s[row], t[row], normal[row]}, tau[row], momentum));
    out.value(row, "momentum", "momentum", momentum);
    for (int k = 0; k < 4; k++)
      out.triple(row, end[k], ends.velocity[k]);
  }
}

static void event_drift(const OperatorInput &in, Writer &out)
{
  std::vector<Point> position = in.group.points("position");
  std::vector<Vector> velocity = in.group.vectors("velocity");
  std::vector<ContactRow> rows;
  const Fibers fibers(in.model);
  EventDrift(in.model, fibers)
      .drift(in.group.real("time", "dt"), in.group.real("time", "start"), position, velocity, &rows);
  for (size_t k = 0; k < rows.size(); k++) {
    const ContactRow &row = rows[k];
    out.value(k, "event", "bond", (int64_t)row.bond), out.value(k, "event", "other", (int64_t)row.other);
    out.value(k, "event", "image_x", (int64_t)row.image[0]), out.value(k, "event", "image_y", (int64_t)row.image[1]);
    out.value(k, "event", "image_z", (int64_t)row.image[2]), out.value(k, "event", "tick", row.tick);
    const Vector n = row.contact.normal;
    out.value(k, "hit", "s", row.contact.s), out.value(k, "hit", "t", row.contact.t);
    out.value(k, "hit", "normal_x", n.x), out.value(k, "hit", "normal_y", n.y), out.value(k, "hit", "normal_z", n.z);
    out.value(k, "hit", "momentum", row.momentum);
  }
  out.triples("position", position), out.triples("velocity", velocity);
}

/* --- forces ----------------------------------------------------------------------------------------------------- */

template <int parts> static void force(const OperatorInput &in, Writer &out)
{
  std::vector<Vector> found;
  Fibers(in.model).forces(in.group.points("position"), parts, found);
  out.triples("force", found);
}

static void kick(const OperatorInput &in, Writer &out)
{
  std::vector<Vector> velocity = in.group.vectors("velocity");
  Fibers(in.model).kick(in.group.real("time", "dt"), in.group.vectors("force"), velocity);
  out.triples("velocity", velocity);
}

static void nothing(const OperatorInput &, Writer &)
{
}

static Operator operator_of(std::string_view name)
{
  static const NamedOperator known[] = {{"model", nothing},
               {"random", random_numbers},
               {"permutation", any_permutation},
               {"order", order_of_vertices},
               {"crossing", crossing},
               {"exchange", exchange},
               {"sweep", sweep},
               {"long_sweep", sweep},
               {"contact_search", contact_search},
               {"impulse", impulses},
               {"event_drift", event_drift},
               {"long_event_drift", event_drift},
               {"bond_force", force<BONDS>},
               {"bend_force", force<BENDS>},
               {"force", force<ALL_FORCES>},
               {"kick", kick}};
  for (const Operator function : {operator_among(known, name), solvent_operator(name), flow_operator(name)})
    if (function)
      return function;
  return nullptr;
}

std::string operators_of(const Pack &pack)
{
  for (const auto &[place, group] : pack.groups)
    if (!operator_of(place.first))
      throw BadInput("this port has no operator " + std::string(place.first));
  const Model model = read_model(pack);
  std::string text;
  for (const auto &[place, group] : pack.groups) {
    Writer out = {text, std::string(place.first) + " " + std::to_string(place.second) + " "};
    operator_of(place.first)({model, group, place.second}, out);
  }
  return text;
}
