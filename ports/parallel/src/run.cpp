#include "run.h"

Run::Run(const Model &model, State &state, const Settings &settings)
    : model(model), state(state), solvent(model, state, settings), before(state.counts), fibers(model),
      contacts(model, fibers), sweep(model)
{
}

const State &Run::now()
{
  solvent.fetch(state);
  const DriftCounts &found = contacts.counts;
  state.counts.possible = before.possible + found.executed + sweep.possible;
  state.counts.executed = before.executed + found.executed + sweep.executed;
  state.counts.negative = before.negative + sweep.negative;
  state.counts.softened = before.softened + found.softened, state.counts.rigid = before.rigid + found.rigid;
  return state;
}

void Run::told(uint64_t number, const char *stage)
{
  if (after_stage)
    after_stage(number, stage);
}

void Run::steps(int64_t number)
{
  last = state.step + (uint64_t)number;
  for (int64_t k = 0; k < number; k++)
    one_step();
}

void Run::one_step()
{
  const uint64_t number = state.step + 1;
  const double dt = model.time_step;
  const bool collides = model.interval > 0 && number % (uint64_t)model.interval == 0; // 0: no solvent
  if (collides && model.scheme == DRIFT_SPLIT) {
    drift(number, 0.5 * dt, 0);
    collide(number);
    drift(number, 0.5 * dt, 1);
  } else {
    drift(number, dt, 0);
  }
  if (collides && model.scheme == PAPER)
    collide(number);
  force(number);
  if (collides && model.scheme == KICK_SPLIT) {
    kick(number, 0.5 * dt);
    collide(number);
    kick(number, 0.5 * dt);
  } else {
    kick(number, dt);
  }
  state.step = number;
  told(number, "end");
}

// A drift adds 2 to the lag, half a drift 1.
void Run::drift(uint64_t number, double time, uint32_t which)
{
  if (!state.vertex.empty() && model.event_driven)
    contacts.drift(time, which == 0 ? -0.5 * model.time_step : 0.0, state.vertex, state.vertex_velocity, rows);
  else if (!state.vertex.empty())
    sweep.move(time, permutation(model.source(VERTEX_ORDER, number), which, (uint32_t)model.vertices()), state.vertex,
               state.vertex_velocity, nullptr);
  state.lag += time == model.time_step ? 2 : 1;
  state.counts.moves += model.forbidden ? (int64_t)state.vertex.size() : 0;
  told(number, "drift");
}

// The solvent streams when a collision comes, for the whole time since the last one.
void Run::collide(uint64_t number)
{
  solvent.collide(number, (double)state.lag * (model.time_step / 2.0), state);
  state.lag = 0;
  const uint64_t next = number + (uint64_t)model.interval;
  if (!after_stage && next <= last)
    solvent.fly_ahead(next, (double)(2 * model.interval) * (model.time_step / 2.0));
  told(number, "collide");
}

void Run::force(uint64_t number)
{
  if (state.vertex.empty())
    return;
  fibers.forces(state.vertex, ALL_FORCES, forces);
  told(number, "force");
}

void Run::kick(uint64_t number, double time)
{
  if (state.vertex.empty())
    return;
  fibers.kick(time, forces, state.vertex_velocity);
  told(number, "kick");
}
