#include "fluid/fluid.h"

#include "fluid/boundary.h"

const struct fluid *fluid_row(enum fluid_kind kind)
{
  static const struct fluid *const fluids[FLUIDS] = {
      [FLUID_POINTS] = &fluid_points, [FLUID_DUMBBELLS] = &fluid_dumbbells};
  return fluids[kind];
}

const struct fluid *fluid_of(const struct model *model)
{
  return fluid_row(model_has_dumbbells(model) ? FLUID_DUMBBELLS : FLUID_POINTS);
}

bool fluid_stream(struct state *state, const struct model *model, struct fault *fault)
{
  const bool ok = fluid_of(model)->stream(state, model, 0, state->solvent.n, fault);
  state_streamed(state);
  return ok;
}

struct point fluid_position_now(const struct state *state, const struct model *model, uint32_t i)
{
  struct point at;
  fluid_of(model)->now(state, model, i, 1, &at, NULL);
  return at;
}

struct vec3 fluid_velocity_now(const struct state *state, const struct model *model, uint32_t i)
{
  struct vec3 v;
  fluid_of(model)->now(state, model, i, 1, NULL, &v);
  return v;
}

struct vec3 fluid_gain(const struct state *state, const struct model *model)
{
  const struct span span = boundary_lag(state, model);
  return vec3_scale(span.time, span.acceleration);
}
