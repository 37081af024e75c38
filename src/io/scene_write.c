/* The effective scene, written out: every default filled in, every number to the last bit. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "io/scene.h"
#include "io/scene_keys.h"

/* The shortest decimal number that reads back to the same double. */
static void write_number(FILE *f, double x)
{
  char text[32];
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, x);
    if (strtod(text, NULL) == x)
      break;
  }
  fputs(text, f);
}

static void write_line(FILE *f, const char *key, double x)
{
  fputs(key, f);
  write_number(f, x);
  fputc('\n', f);
}

static void write_vector(FILE *f, const char *key, struct vec3 v, const char *end)
{
  const double x[3] = {v.x, v.y, v.z};
  fputs(key, f);
  for (int i = 0; i < 3; i++) {
    fputs(i ? ", " : "[", f);
    write_number(f, x[i]);
  }
  fprintf(f, "]%s", end);
}

static const char *word(bool on)
{
  return on ? "true" : "false";
}

static void write_solvent(FILE *f, const struct model *m)
{
  const struct solvent_model *s = &m->solvent;
  fputs("solvent:\n", f);
  write_line(f, "  per_cell: ", s->per_cell);
  write_line(f, "  collision_interval: ", model_collision_interval(m));
  write_line(f, "  rotation_angle: ", s->rotation_angle);
  fprintf(f, "  thermostat: %s\n  hydrodynamics: %s\n", scene_thermostat_words[s->thermostat], word(s->hydrodynamics));
  fprintf(f, "  bath: %s\n", scene_bath_words[s->bath]);
  write_vector(f, "  acceleration: ", s->acceleration, "\n");
}

static void write_kind(FILE *f, const struct fiber_kind *k)
{
  fprintf(f, "  - name: %s\n    count: %" PRIu32 "\n    vertices: %" PRIu32 "\n    ring: %s\n", k->name, k->count,
          k->vertices, word(k->ring));
  write_line(f, "    mass: ", k->mass);
  write_line(f, "    bond_length: ", k->bond_length);
  write_line(f, "    spring: ", k->spring);
  write_line(f, "    bending: ", k->bending);
  write_vector(f, "    force: ", k->force, "\n");
  fprintf(f, "    start: %s\n", scene_start_words[k->start]);
  if (k->placed > 0)
    fputs("    places:\n", f);
  for (uint32_t i = 0; i < k->placed; i++) {
    write_vector(f, "      - {center: ", k->center[i], "");
    write_vector(f, ", direction: ", k->direction[i], "}\n");
  }
}

static void write_physics(FILE *f, const struct scene *scene)
{
  const struct model *m = &scene->model;
  fprintf(f, "box: [%d, %d, %d]\n", m->box.cells[0], m->box.cells[1], m->box.cells[2]);
  write_line(f, "time_step: ", m->time_step);
  fprintf(f, "order: %s\n", scene_order_words[m->order]);
  write_vector(f, "flow: ", m->flow, "\n");
  if (model_collides(m))
    write_solvent(f, m);
  if (m->kinds > 0)
    fputs("fibers:\n", f);
  for (uint32_t k = 0; k < m->kinds; k++)
    write_kind(f, &m->kind[k]);
  fprintf(f, "crossing:\n  forbidden: %s\n  exclusion: %s\n  refusal: %s\n  frame: %s\n", word(m->crossing.forbidden),
          scene_exclusion_words[m->crossing.exclusion], scene_refusal_words[m->crossing.refusal],
          scene_frame_words[m->crossing.frame]);
}

/* A text in double quotes, as YAML reads it. */
static void write_quoted(FILE *f, const char *text)
{
  fputc('"', f);
  for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
    if (*c < 0x20 || *c == 0x7f)
      fprintf(f, "\\x%02x", *c);
    else
      fprintf(f, "%s%c", *c == '"' || *c == '\\' ? "\\" : "", *c);
  }
  fputs("\"\n", f);
}

static void write_observe(FILE *f, const struct observe_plan *plan)
{
  bool any = false;
  for (int i = 0; i < OBSERVABLES; i++)
    if (plan->every[i] > 0) {
      fprintf(f, "%s  %s: {every: %" PRIu64, any ? "" : "observe:\n", observable_names[i], plan->every[i]);
      if (i == OBSERVE_DYNAMICS)
        fprintf(f, ", longest_lag: %" PRIu64, plan->longest_lag);
      fputs("}\n", f);
      any = true;
    }
}

void scene_write(const struct scene *scene, FILE *f, bool physics_only)
{
  write_physics(f, scene);
  if (scene->snapshot) {
    fputs("start:\n  snapshot: ", f);
    write_quoted(f, scene->snapshot);
  }
  if (physics_only)
    return;
  fprintf(f, "steps: %" PRIu64 "\nseed: %" PRIu64 "\n", scene->steps, scene->model.seed);
  write_observe(f, &scene->observe);
  if (scene->trajectory_every > 0)
    fprintf(f, "trajectory: {every: %" PRIu64 ", solvent: %s, velocities: %s}\n", scene->trajectory_every,
            word(scene->trajectory_solvent), word(scene->trajectory_velocities));
  write_line(f, "checkpoint:\n  seconds: ", scene->checkpoint_seconds);
}
