/* Langevin and Andersen: each vertex has a bath of its own, which moves with the flow. Vertices are worked on in
 * blocks, so that their random numbers vectorise. */
#include "base/normal.h"
#include "medium/medium.h"

enum { BLOCK = RANDOM_UNIFORMS };

/* The bath of a step. */
struct acting {
  const struct bath_draw *draw;
  double x, loss; /* rate dt; 1 - c */
  uint64_t step;
};

/* Those of vertices first .. first + n - 1 on which the bath acts. */
static uint32_t choose(const struct model *model, const struct acting *how, uint32_t first, uint32_t n,
                       uint32_t *vertex)
{
  uint32_t word[4][BLOCK], *columns[4] = {word[0], word[1], word[2], word[3]}, chosen = 0;
  for (uint32_t k = 0; k < n; k++)
    vertex[k] = first + k;
  if (!how->draw->chooses)
    return n;
  random_columns(model->seed, RANDOM_BATH_VERTEX, 1, how->step, vertex, n, columns);
  for (uint32_t k = 0; k < n; k++) {
    vertex[chosen] = first + k;
    chosen += bath_chooses(word[0][k], how->x);
  }
  return chosen;
}

static void act(struct state *state, const struct model *model, const struct acting *how, const uint32_t *vertex,
                uint32_t n)
{
  const bool flat = model_is_flat(model);
  const double loss = how->loss;
  double noise[BLOCK], x[BLOCK], y[BLOCK], z[BLOCK];
  random_normal_three_columns(model->seed, RANDOM_BATH_VERTEX, 0, how->step, vertex, n, x, y, z);
  for (uint32_t k = 0; k < n; k++)
    noise[k] = bath_noise(loss, 1.0 / model->mass[vertex[k]]); /* NOLINT(clang-analyzer-*): choose filled n of them */
  for (uint32_t k = 0; k < n; k++) {
    struct vec3 *v = &state->velocity[vertex[k]];
    const struct vec3 u = vec3_sub(*v, model->flow);
    *v = vec3_add(*v, (struct vec3){bath_change(u.x, loss, noise[k] * x[k]), bath_change(u.y, loss, noise[k] * y[k]),
                                    flat ? 0.0 : bath_change(u.z, loss, noise[k] * z[k])});
  }
}

bool private_collide(struct state *state, const struct model *model, struct medium *medium, uint64_t step,
                     struct fault *fault)
{
  (void)medium, (void)fault;
  struct acting how = {
      .draw = bath_draw_of(model->medium.draw), .x = model->medium.rate * model->time_step, .step = step};
  uint32_t vertex[BLOCK];
  how.draw->lose(&how.x, 1, &how.loss);
  for (uint32_t first = 0; first < state->vertices; first += BLOCK) {
    const uint32_t n = state->vertices - first < BLOCK ? state->vertices - first : BLOCK;
    act(state, model, &how, vertex, choose(model, &how, first, n, vertex));
  }
  return true;
}
