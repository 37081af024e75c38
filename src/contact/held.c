#include "contact/held.h"

void held_set_aside(struct state *state, const struct model *model, struct vec3 *aside)
{
  for (uint32_t v = 0; v < state->vertices; v++)
    if (model_is_held(model, v)) {
      aside[v] = state->velocity[v];
      state->velocity[v] = (struct vec3){0, 0, 0};
    }
}

void held_give_back(struct state *state, const struct model *model, const struct vec3 *aside)
{
  for (uint32_t v = 0; v < state->vertices; v++)
    if (model_is_held(model, v))
      state->velocity[v] = aside[v];
}
