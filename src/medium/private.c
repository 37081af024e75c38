/* Langevin and Andersen: each vertex has a bath of its own, which moves with the flow. */
#include "base/normal.h"
#include "medium/medium.h"

bool private_collide(struct state *state, const struct model *model, struct medium *medium, uint64_t step,
                     struct fault *fault)
{
  (void)medium, (void)fault;
  const struct bath_draw *draw = bath_draw_of(model->medium.draw);
  const double x = model->medium.rate * model->time_step;
  double loss;
  draw->lose(&x, 1, &loss);
  for (uint32_t v = 0; v < state->vertices; v++) {
    if (draw->chooses && !bath_chooses(random_at(model->seed, RANDOM_BATH_VERTEX, 1, step, v).w[0], x))
      continue;
    double normal[3];
    random_normal_three(random_at(model->seed, RANDOM_BATH_VERTEX, 0, step, v), normal);
    const struct vec3 u = vec3_sub(state->velocity[v], model->flow);
    const double noise = bath_noise(loss, 1.0 / model->mass[v]);
    const struct vec3 change = {bath_change(u.x, loss, noise * normal[0]), bath_change(u.y, loss, noise * normal[1]),
                                model_is_flat(model) ? 0.0 : bath_change(u.z, loss, noise * normal[2])};
    state->velocity[v] = vec3_add(state->velocity[v], change);
  }
  return true;
}
