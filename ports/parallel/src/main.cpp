// A port of uncross for all cores and for a GPU.
#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>

#include "operators.h"
#include "run.h"

static const char usage[] = "usage: port PACK OUT           outputs of all operators of a pack (text)\n"
                            "       port --trace START OUT  the trace of a start (text)\n"
                            "       port --run START [option ...]          runs a start, prints the state hash\n"
                            "       port --solvent X,Y,Z [option ...]      the same of a solvent that is drawn here\n"
                            "options: --steps N  --warm N (steps before the clock)  --sort N\n"
                            "         --every N --states FILE (the state after every N steps, as bytes)\n"
                            "         --apart (on a GPU each thread adds alone)  --unfused  --one-by-one\n"
                            "         --per-cell N  --interval N  --dt T  --seed S\n"
                            "         --degrees A  --thermostat 0, 1 or 2  --at-a\n";

// Number and hash of the contacts since the row before.
static std::string columns_of(std::vector<ContactRow> &rows)
{
  WordHash hash;
  for (const ContactRow &row : rows)
    for (const int64_t word : {(int64_t)row.bond, (int64_t)row.other, (int64_t)row.image[0], (int64_t)row.image[1],
                               (int64_t)row.image[2], row.tick})
      hash.add((uint64_t)word);
  char text[64];
  std::snprintf(text, sizeof text, ",%zu,%016" PRIx64, rows.size(), hash.value());
  rows.clear();
  return text;
}

static std::string trace(const Pack &pack)
{
  const Model model = read_model(pack);
  State state = read_state(pack);
  Run run(model, state, Settings{});
  std::vector<ContactRow> rows;
  run.rows = &rows;
  std::string text = model.event_driven ? "step,stage,state_hash,contacts,contacts_hash\n" : "step,stage,state_hash\n";
  run.after_stage = [&](uint64_t number, const char *stage) {
    char line[96];
    std::snprintf(line, sizeof line, "%" PRIu64 ",%s,%016" PRIx64, number, stage, state_hash(run.now()));
    text += line;
    if (model.event_driven)
      text += columns_of(rows);
    text += "\n";
  };
  run.after_stage(state.step, "start");
  run.steps(model.steps);
  return text;
}

struct Options {
  const char *cells = nullptr;
  int64_t steps = -1, warm = 0, per_cell = 5, every = 0;
  std::string states;
  Settings settings;
  Model model; // of a solvent that is drawn here
};

static void turn_by(Model &model, double degrees)
{
  const CirclePoint at = circle_degrees(degrees);
  model.cosine = at.cosine, model.sine = at.sine;
}

static Options read_options(int count, char **word)
{
  Options o;
  o.model.time_step = 0.02, o.model.sine = 1.0, o.model.seed = 1;
  for (int k = 0; k < count; k++) {
    const std::string name = word[k];
    if (name == "--apart") {
      o.settings.transposed = 0;
    } else if (name == "--one-by-one") {
      o.settings.one_by_one = true;
    } else if (name == "--unfused") {
      o.settings.fused = false;
    } else if (name == "--at-a") {
      o.model.andersen = true;
    } else if (k + 1 == count) {
      throw BadInput("unknown option, or its value is missing: " + name);
    } else {
      const char *value = word[++k];
      if (name == "--steps")
        o.steps = std::atoll(value);
      else if (name == "--every")
        o.every = std::atoll(value);
      else if (name == "--states")
        o.states = value;
      else if (name == "--warm")
        o.warm = std::atoll(value);
      else if (name == "--sort")
        o.settings.sort_every = std::atoi(value);
      else if (name == "--per-cell")
        o.per_cell = std::atoll(value);
      else if (name == "--interval")
        o.model.interval = std::atoll(value);
      else if (name == "--dt")
        o.model.time_step = std::atof(value);
      else if (name == "--thermostat")
        o.model.thermostat = std::atoi(value);
      else if (name == "--degrees")
        turn_by(o.model, std::atof(value));
      else if (name == "--seed")
        o.model.seed = std::strtoull(value, nullptr, 10);
      else
        throw BadInput("unknown option " + name);
    }
  }
  return o;
}

static double now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Row> static void put(std::ofstream &to, const std::vector<Row> &rows)
{
  to.write((const char *)rows.data(), (std::streamsize)(rows.size() * sizeof(Row)));
}

// 13 whole numbers of 64 bits, then the rows: ports/parallel/run reads them.
static void write_state(std::ofstream &to, const State &state)
{
  const CollisionCounts &n = state.counts;
  put(to, std::vector<uint64_t>{state.step, state.lag, state.solvent.size(), state.vertex.size(), state.account.size(),
                                state_hash(state), state_digest(state), (uint64_t)n.moves, (uint64_t)n.possible,
                                (uint64_t)n.executed, (uint64_t)n.negative, (uint64_t)n.softened, (uint64_t)n.rigid});
  put(to, state.solvent), put(to, state.solvent_velocity);
  put(to, state.vertex), put(to, state.vertex_velocity), put(to, state.account);
  to.flush();
  if (!to)
    throw std::runtime_error("a state could not be written");
}

static void run_to(Run &run, int64_t steps, const Options &o)
{
  if (o.every <= 0) {
    run.steps(steps);
    return;
  }
  std::ofstream to(o.states, std::ios::binary);
  for (int64_t made = 0; made < steps;) {
    const int64_t next = std::min(steps - made, o.every);
    run.steps(next);
    made += next;
    write_state(to, run.now());
  }
}

static void run_and_report(const Model &model, State &state, const Options &o)
{
  Run run(model, state, o.settings);
  const int64_t steps = o.steps >= 0 ? o.steps : model.steps, warm = o.warm < steps ? o.warm : steps;
  run.steps(warm);
  device_wait();
  const double begin = now();
  run_to(run, steps - warm, o);
  device_wait();
  const double seconds = now() - begin, particles = (double)state.solvent.size();
  const double collisions = (double)(steps - warm) / (double)model.interval;
  const uint64_t hash = state_hash(run.now());
  const DriftCounts &counts = run.contact_counts();
  std::printf("{\"hash\": \"%016" PRIx64 "\", \"cells\": [%" PRId64 ", %" PRId64 ", %" PRId64 "], "
              "\"particles\": %zu, \"vertices\": %zu, \"steps\": %" PRId64 ", \"timed_steps\": %" PRId64 ", "
              "\"seconds\": %.6f, \"ms_per_step\": %.6f, \"ns_per_particle_and_collision\": %.4f, \"gpu\": %s, "
              "\"events\": %" PRId64 ", \"components\": %" PRId64 ", \"joined\": %" PRId64 ", \"largest\": %" PRId64
              ", \"lists\": %" PRId64 "}\n",
              hash, model.cells[0], model.cells[1], model.cells[2], state.solvent.size(), state.vertex.size(), steps,
              steps - warm, seconds, steps > warm ? 1e3 * seconds / (double)(steps - warm) : 0.0,
              collisions > 0 && particles > 0 ? 1e9 * seconds / (particles * collisions) : 0.0,
              on_gpu ? "true" : "false", counts.events, counts.components, counts.joined, counts.largest, counts.lists);
}

static void run_solvent(const char *cells, Options &o)
{
  Model &model = o.model;
  if (std::sscanf(cells, "%" SCNd64 ",%" SCNd64 ",%" SCNd64, &model.cells[0], &model.cells[1], &model.cells[2]) != 3)
    throw BadInput("three numbers of cells are needed, such as 32,32,32");
  model.particles = o.per_cell * model.cell_count();
  State state = draw_solvent(model);
  run_and_report(model, state, o);
}

int main(int count, char **word)
{
  try {
    const std::string first = count > 1 ? word[1] : "";
    if (first == "--trace" && count == 4) {
      write_file(word[3], trace(Pack(read_file(word[2]))));
    } else if (count == 3 && first.substr(0, 2) != "--") {
      write_file(word[2], operators_of(Pack(read_file(word[1]))));
    } else if (first == "--run" && count >= 3) {
      const Options o = read_options(count - 3, word + 3);
      const Pack pack(read_file(word[2]));
      const Model model = read_model(pack);
      State state = read_state(pack);
      run_and_report(model, state, o);
    } else if (first == "--solvent" && count >= 3) {
      Options o = read_options(count - 3, word + 3);
      run_solvent(word[2], o);
    } else {
      std::fputs(usage, stderr);
      return 2;
    }
    return 0;
  } catch (const BadInput &error) {
    std::fprintf(stderr, "port: %s\n", error.what());
    return 2;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "port: %s\n", error.what());
    return 1;
  }
}
