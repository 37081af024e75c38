/* What scenes may not say of a medium, where it stands, and that nothing else is said. */
#include "scene/scene_keys.h"
#include "support.h"

#define FIBER "\nfibers: [{name: a, count: 2, vertices: 3, mass: 1, bond_length: 0.5, spring: 100}]"

static const struct refusal {
  const char *line; /* the fifth of the scene */
  int column;
  const char *says;
} refusals[] = {
    {"medium: {rate: 1, density: 3}", 9, "medium: key 'kind' is missing"},
    {"medium: {kind: pairs, density: 3}", 9, "medium: key 'rate' is missing"},
    {"medium: {kind: pair, rate: 1, density: 3}", 16, "allowed: private | pairs | overdamped"},
    {"medium: {kind: pairs, rate: 0, density: 3}", 29, "medium.rate: '0' is out of range"},
    {"medium: {kind: pairs, rate: -1, density: 3}", 29, "medium.rate: '-1' is out of range"},
    {"medium: {kind: pairs, rate: nan, density: 3}", 29, "medium.rate"},
    {"medium: {kind: pairs, rate: 10.001, density: 3}", 29, "no probability; allowed with draw: replace: up to 10"},
    {"medium: {kind: pairs, rate: 1, density: -3}", 41, "medium.density: '-3' is out of range"},
    {"medium: {kind: pairs, rate: 1}", 16, "pairs without a density"},
    {"medium: {kind: pairs, rate: 1, density: 1e-9}", 41, "makes 0 particles"},
    {"medium: {kind: pairs, rate: 1, weight: -1, density: 3}", 40, "allowed: hat | quadratic"},
    {"medium: {kind: pairs, rate: 1, draw: again, density: 3}", 38, "allowed: replace | relax | cayley"},
    {"medium: {kind: pairs, rate: 1, density: 3, cutoff: 2}", 44, "unknown key 'cutoff'"},
    {"medium: {kind: pairs, rate: 1, density: 3, repulsion: -1}", 55, "an attraction without many_body"},
    {"medium: {kind: pairs, rate: 1, density: 3, repulsion: 1001}", 55, "medium.repulsion: '1001' is out of range"},
    {"medium: {kind: pairs, rate: 1, density: 3, second: {share: 0.0005, repulsion: 50}}", 60,
     "a group that no one has"},
    {"medium: {kind: pairs, rate: 1, density: 3, second: {share: 0.5}}", 52, "key 'repulsion' is missing"},
    {"medium: {kind: pairs, rate: 1, density: 3, many_body: {repulsion: 25, range: 1.5}}", 78, "is out of range"},
    {"medium: {kind: private, rate: 1, repulsion: 25}" FIBER, 16, "knows no distances, so no repulsion"},
    {"medium: {kind: private, rate: 1}", 16, "there are no fibers"},
    {"medium: {kind: overdamped, rate: 1}", 16, "there are no fibers"},
    {"medium: {kind: overdamped, rate: 1, tensor: rpy}\ncrossing: {forbidden: false}" FIBER, 45,
     "a tensor needs a radius"},
    {"medium: {kind: overdamped, rate: 1, radius: 0.3}\ncrossing: {forbidden: false}" FIBER, 45, "a radius a tensor"},
    {"medium: {kind: overdamped, rate: 1, draw: relax}\ncrossing: {forbidden: false}" FIBER, 16, "draws no velocities"},
    {"medium: {kind: overdamped, rate: 1, density: 3}\ncrossing: {forbidden: false}" FIBER, 46, "has no particles"},
    {"medium: {kind: overdamped, rate: 1, tensor: stokes}" FIBER, 45, "allowed: none | oseen | rpy"},
    {"medium: {kind: private, rate: 1, inextensible: true}" FIBER, 48, "allowed with kind: overdamped"},
    {"medium: {kind: overdamped, rate: 1, inextensible: true}\ncrossing: {forbidden: false}\nfibers:\n  - {name: f, "
     "count: 1, "
     "vertices: 2, mass: 1, bond_length: 0, spring: 1}",
     51, "which no tension can hold"},
    {"medium: {kind: private, rate: 10.001}" FIBER, 31, "no probability"},
    {"medium: {kind: private, rate: 1, density: 3}" FIBER, 43, "a private bath has no particles"},
    {"medium: {kind: private, rate: 1, weight: quadratic}" FIBER, 42, "knows no distances"},
};

/* Of lines whose fault stands elsewhere. */
static const struct elsewhere {
  const char *first, *last, *place, *says;
} others[] = {
    {"box: [6, 2, 6]", "medium: {kind: pairs, rate: 1, density: 3}", "m.yaml:1:6: ", "less than 3 a0"},
    {"box: [6, 6, 6]", "medium: {kind: pairs, rate: 1, density: 3}\nsolvent: {per_cell: 5, collision_interval: 0.1}",
     "m.yaml:5:9: ", "there is a solvent of collision cells too"},
    {"box: [6, 6, 6]", "medium: {kind: pairs, rate: 1, density: 3}\nwalls: {kind: no-slip}",
     "m.yaml:6:8: ", "rules for walls"},
    {"box: [6, 6, 6]", "medium: {kind: pairs, rate: 1, density: 3}\nshear: {rate: 0.1}",
     "m.yaml:6:8: ", "images that slide"},
    {"box: [6, 6, 6]", "medium: {kind: pairs, rate: 1, density: 3}\ndumbbells: {spring: 1}",
     "m.yaml:6:12: ", "has springs"},
    {"box: [6, 6, 6]",
     "medium: {kind: pairs, rate: 1, density: 3, repulsion: 25}\ncrossing: {rule: event-driven}" FIBER,
     "m.yaml:6:18: ", "allowed with repulsion: sequential"},
    {"box: [6, 6, 6]", "medium: {kind: overdamped, rate: 1}\ncrossing: {forbidden: true}" FIBER,
     "m.yaml:6:23: ", "cannot exchange momentum"},
    {"box: [6, 6, 6]", "medium: {kind: overdamped, rate: 1}\nwalls: {kind: no-slip}" FIBER,
     "m.yaml:6:8: ", "rules for walls"},
    {"box: [6, 6, 6]",
     "medium: {kind: overdamped, rate: 1, inextensible: true}\ncrossing: {forbidden: false}\nobserve: {pressure: "
     "{every: 1}}" FIBER,
     "m.yaml:7:21: ", "the tension of bonds is not in its stress"},
};

static bool read_scene(const char *first, const char *last, struct scene *scene, struct message *message)
{
  char text[1024];
  snprintf(text, sizeof text, "%s\ntime_step: 0.1\nsteps: 10\norder: drift-split\n%s\n", first, last);
  return scene_read_source(&(struct scene_source){.keys = &scene_keys,
                                                  .path = "m.yaml",
                                                  .text = text,
                                                  .size = strlen(text),
                                                  .missing = MISSING_ABSENT,
                                                  .message = message},
                           scene);
}

static void expect(const char *first, const char *last, const char *place, const char *says)
{
  struct scene scene;
  struct message message = {.text = ""};
  if (read_scene(first, last, &scene, &message))
    fail_msg("accepted: %s", last);
  if (!strstr(message.text, says) || strncmp(message.text, place, strlen(place)) != 0)
    fail_msg("%s\nsays: %s", last, message.text);
}

static void refused_with_their_place(void **unused)
{
  (void)unused;
  for (size_t k = 0; k < sizeof refusals / sizeof *refusals; k++) {
    char place[32];
    snprintf(place, sizeof place, "m.yaml:5:%d: ", refusals[k].column);
    expect("box: [6, 6, 6]", refusals[k].line, place, refusals[k].says);
  }
  for (size_t k = 0; k < sizeof others / sizeof *others; k++)
    expect(others[k].first, others[k].last, others[k].place, others[k].says);
}

/* The bounds themselves are allowed. */
static void bounds(void **unused)
{
  (void)unused;
  static const char *const lines[] = {
      "medium: {kind: pairs, rate: 10, density: 3}",
      "medium: {kind: pairs, rate: 1000, density: 3, draw: relax, weight: quadratic}",
      ("medium: {kind: private, rate: 10}" FIBER),
      "medium: {kind: pairs, rate: 1, density: 3, repulsion: -40, many_body: {repulsion: 25}}",
      "medium: {kind: overdamped, rate: 1, inextensible: true}\ncrossing: {forbidden: false}\nfibers:\n"
      "  - {name: f, count: 1, vertices: 3, mass: 5, bond_length: 0.5, spring: 1000000}", /* which has no effect */
      "medium: {kind: pairs, rate: 1, density: 3, repulsion: 25, second: {share: 1, repulsion: 50, start: slab}}",
  };
  for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
    struct scene scene;
    struct message message = {.text = ""};
    if (!read_scene("box: [3, 3, 3]", lines[k], &scene, &message))
      fail_msg("%s\nsays: %s", lines[k], message.text);
    scene_free(&scene);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(refused_with_their_place), cmocka_unit_test(bounds)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
