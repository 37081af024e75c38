/* The state in which a run of a scene begins. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "bead/bead.h"
#include "files/snapshot.h"
#include "files/start.h"
#include "observe/conserved.h"
#include "scene/scene.h"
#include "start/fibers.h"
#include "start/start.h"
#include "system/sound.h"
#include "wall/motion.h"

/* --- what flows -------------------------------------------------------------------------------------------------- */

#define FLOW_ROUNDING 1e-6 /* a0/t0 */
#define FLOW_HEAT 6.0      /* standard deviations of the thermal velocity of a center of mass */
#define FASTEST 131072.0   /* a0/t0, in the sums of motion_measure */

/* Along y nothing may be said to flow across walls or shear. */
static bool may_flow_along_y(const struct model *m)
{
  return m->box.boundary[1] == BOUNDARY_PERIODIC;
}

/* Whether a scene may say this flow. */
static bool may_be_said(struct vec3 flow)
{
  return fmax(fabs(flow.x), fmax(fabs(flow.y), fabs(flow.z))) <= MODEL_MOST_FLOW;
}

/* Where the scene says what flows, or else from what it starts. crossed: along y, where nothing may. */
static bool refuse_flow(const struct scene *scene, struct vec3 found, bool crossed, struct message *message)
{
  const struct model *m = &scene->model;
  const char *key = scene_says(scene, "flow") ? "flow" : "start.snapshot";
  if (!isfinite(found.x + found.y + found.z))
    return message_no_memory(message, "no memory to look at the starting state");
  found.y = may_flow_along_y(m) || crossed ? found.y : 0.0;
  return scene_refuse_at(scene, key, "flow", message,
                         "the center of mass of '%s' moves at [%.9g, %.9g, %.9g] a0/t0%s, and a snapshot is given no "
                         "other velocity; %s (a flow is at most %g along each axis%s)",
                         scene->snapshot, found.x, found.y, found.z,
                         model_is_sheared(m) ? " about the linear flow" : "",
                         may_be_said(found) && !crossed ? "allowed: that one" : "no scene starts from it",
                         MODEL_MOST_FLOW, may_flow_along_y(m) ? "" : ", none along y across walls or shear");
}

/* Sums over all particles: m (y - L/2), of a vertex of its image there, and M^2 of what moves by itself. */
struct heights {
  double moment, squares;
};

static struct heights sum_heights(const struct model *m, const struct state *state)
{
  const double middle = 0.5 * m->box.cells[1];
  struct heights h = {0.0, state->solvent.n};
  for (uint32_t i = 0; i < state->solvent.n; i++)
    h.moment += (double)state->solvent.y[i] * LATTICE_UNIT - middle;
  for (uint32_t f = 0; f < m->fibers; f++) {
    double mass = 0.0;
    for (uint32_t v = m->fiber_first[f]; v < m->fiber_first[f + 1]; v++) {
      mass += m->mass[v];
      h.moment += m->mass[v] * ((double)state->position[v].y * LATTICE_UNIT - middle);
    }
    h.squares += mass * mass;
  }
  return h;
}

/* The velocity of the center of mass, and how much of it is no flow, along each axis. */
struct center {
  struct vec3 velocity, most;
};

/* Images of a sheared box hand momentum on: that of the laboratory is rate M <y - L/2> off at any time. About the
 * linear flow nothing is handed on, while the rate stays the same; while it changes, <y> has the scatter of so many
 * bodies. */
static void look_at_shear(const struct model *m, const struct state *state, double mass, struct center *c)
{
  const double rate = shear_rate(m, 0), edge = m->box.cells[1];
  const struct heights h = sum_heights(m, state);
  if (m->wave.intervals == 0)
    c->velocity.x -= rate * h.moment / mass;
  else
    c->most.x =
        FLOW_HEAT * sqrt(1.0 / mass + m->shear.rate * m->shear.rate * edge * edge / 12.0 * h.squares / (mass * mass));
}

static struct center look_at_center(const struct model *m, const struct state *state, struct work *work)
{
  const struct motion motion = motion_measure(m, state, work->fiber.force);
  const double mass = m->total_mass + m->bead.mass;
  const double heat = FLOW_HEAT / sqrt(mass), most = vec3_norm(m->flow) > 0.0 ? FLOW_ROUNDING : heat;
  const struct vec3 vertices = vec3_add(motion.vertex.momentum, motion.bead.momentum);
  struct center c = {vec3_scale(1.0 / mass, vec3_add(motion.solvent.sum, vertices)),
                     {most, may_flow_along_y(m) ? most : heat, most}};
  if (model_is_sheared(m))
    look_at_shear(m, state, mass, &c);
  return c;
}

/* A snapshot's displacements are counted from the scene's flow, and its moves may be made in that frame: so it must
 * flow like that. What takes momentum up, a bath, walls, held vertices, takes any snapshot along. */
static bool flows_as_said(const struct scene *scene, const struct state *state, struct work *work,
                          struct message *message)
{
  const struct model *m = &scene->model;
  const struct vec3 axes = start_conserved_axes(m);
  if (m->held > 0 || vec3_norm(axes) == 0.0)
    return true;
  const struct center c = look_at_center(m, state, work);
  const struct vec3 off = vec3_sub(c.velocity, m->flow);
  const bool along_y = axes.y * fabs(off.y) <= c.most.y;
  return (fabs(off.x) <= c.most.x && along_y && fabs(off.z) <= c.most.z) ||
         refuse_flow(scene, c.velocity, !along_y && !may_flow_along_y(m), message);
}

/* Whether a velocity can be summed (motion_measure): `what` and its number tell whose it is. */
static bool can_be_summed(const struct scene *scene, const char *what, uint32_t number, struct vec3 v,
                          struct message *message)
{
  const double along[3] = {v.x, v.y, v.z};
  for (int k = 0; k < 3; k++)
    if (!(fabs(along[k]) < FASTEST))
      return scene_refuse_at(scene, "start.snapshot", "start.snapshot", message,
                             "%s %" PRIu32 " of '%s' moves at %.9g a0/t0 along %c, beyond what can be summed; allowed: "
                             "below %.0f",
                             what, number, scene->snapshot, along[k], "xyz"[k], FASTEST);
  return true;
}

static bool all_can_be_summed(const struct scene *scene, const struct state *state, struct message *message)
{
  const struct solvent *s = &state->solvent;
  bool ok = true;
  for (uint32_t v = 0; ok && v < state->vertices; v++)
    ok = can_be_summed(scene, "vertex", v, state->velocity[v], message);
  for (uint32_t i = 0; ok && i < s->n; i++)
    ok = can_be_summed(scene, "solvent particle", s->id[i], solvent_velocity(s, i), message);
  for (uint32_t b = 0; ok && b < state->beads; b++)
    ok = can_be_summed(scene, "bead", b, state->bead[b].velocity, message);
  return ok;
}

/* A scene in a plane takes no snapshot of something in space. */
static bool is_flat_as_said(const struct scene *scene, const struct state *state, struct message *message)
{
  bool flat = true;
  for (uint32_t i = 0; i < state->solvent.n; i++)
    flat = flat && state->solvent.z[i] == 0 && state->solvent.vz[i] == 0.0;
  for (uint32_t v = 0; v < state->vertices; v++)
    flat = flat && state->position[v].z == 0 && state->velocity[v].z == 0.0;
  if (flat || !model_is_flat(&scene->model))
    return true;
  message_set(
      message,
      "'%s' is not in the plane; allowed with dimensions: 2: a snapshot with all z coordinates and velocities 0",
      scene->snapshot);
  return false;
}

/* The key of a fiber that overlaps or has no room: that of its place, or of its diameter. */
static void key_of_fiber(const struct model *m, uint32_t fiber, char *key, size_t size)
{
  const uint32_t kind = m->fiber_kind_of[fiber];
  uint32_t within = fiber;
  for (uint32_t k = 0; k < kind; k++)
    within -= m->kind[k].count;
  if (within < m->kind[kind].placed)
    snprintf(key, size, "fibers.%" PRIu32 ".places.%" PRIu32 ".center", kind, within);
  else
    snprintf(key, size, "fibers.%" PRIu32 ".diameter", kind);
}

/* With what a fiber that is laid may overlap. */
static const char *what_is_there(const struct model *m)
{
  return !model_has_bead(m) ? "others" : m->thickness > 0 && m->fibers > 1 ? "the bead or with others" : "the bead";
}

/* Tells what is wrong with the start, at the key of the scene that is to blame. Always returns false. */
static bool refuse_start(const struct scene *scene, const struct fault *fault, struct message *message)
{
  const struct model *m = &scene->model;
  char key[80];
  if (fault->code == FAULT_NO_ROOM) {
    key_of_fiber(m, (uint32_t)fault->entity, key, sizeof key);
    return scene_refuse_at(scene, key, key, message,
                           "fiber %" PRId64 " of %" PRIu32 " overlaps with %s wherever it is laid, %.0f times; "
                           "allowed: thinner or fewer fibers, a larger box, or start.snapshot of a state that has room",
                           fault->entity, m->fibers, what_is_there(m), fault->value);
  }
  if (fault->code == FAULT_GIVEN_UP)
    return message_set(message, "given up while fiber %" PRId64 " of %" PRIu32 " was laid", fault->entity, m->fibers);
  if (fault->code != FAULT_OVERLAP && fault->code != FAULT_BEAD_OVERLAP)
    return message_fault(message, fault);
  key_of_fiber(m, m->fiber_of[fault->entity], key, sizeof key);
  if (fault->code == FAULT_BEAD_OVERLAP)
    return scene_refuse_at(scene, scene->snapshot ? "start.snapshot" : key, scene->snapshot ? "start.snapshot" : key,
                           message,
                           "bond %" PRId64 " of fiber %" PRIu32 " overlaps with the bead: its axis is %.9g a0 from the "
                           "center; allowed: more than %.9g",
                           fault->entity, m->fiber_of[fault->entity], fault->value, fault->limit);
  if (fault->limit == 0.0)
    return scene_refuse_at(scene, scene->snapshot ? "start.snapshot" : key, scene->snapshot ? "start.snapshot" : key,
                           message,
                           "bond %" PRId64 " of fiber %" PRIu32 " touches another; allowed: bonds that are apart",
                           fault->entity, m->fiber_of[fault->entity]);
  return scene_refuse_at(scene, scene->snapshot ? "start.snapshot" : key, scene->snapshot ? "start.snapshot" : key,
                         message,
                         "bond %" PRId64 " of fiber %" PRIu32 " overlaps with another: their axes are %.9g a0 apart; "
                         "allowed: more than %.9g",
                         fault->entity, m->fiber_of[fault->entity], fault->value, fault->limit);
}

/* The stream of a run that begins with this state, of a snapshot. */
static bool find_stream(const struct scene *scene, const struct snapshot_origin *origin, const struct state *state,
                        struct stream *stream, struct message *message)
{
  const bool asked = scene->stream == SCENE_STREAM_SEED;
  const uint64_t hash = state_hash(state);
  *stream = asked ? stream_asked(scene->seed, origin->has_stream, origin->stream, origin->step)
                  : stream_of_snapshot(scene->seed, origin->has_stream, origin->stream, origin->step, hash);
  stream->untold = origin->untold;
  return hash != 0 || message_no_memory(message, "no memory to look at the starting state");
}

static bool start_from_snapshot(struct scene *scene, struct state *state, struct work *work, struct stream *stream,
                                struct message *message)
{
  const struct model *m = &scene->model;
  struct snapshot_origin origin;
  if (!scene_finds_snapshot(scene, message))
    return false;
  char *path = scene_snapshot_path(scene);
  message_no_memory(message, "no memory for the path of the snapshot");
  bool ok = path && snapshot_read_start(path, m, state, &origin, message);
  free(path);
  if (ok)
    shear_begin(&scene->model, origin.slide);
  ok = ok && (state_sound(state, m, &work->fault) || message_fault(message, &work->fault)) &&
       all_can_be_summed(scene, state, message) && is_flat_as_said(scene, state, message) &&
       flows_as_said(scene, state, work, message) &&
       (start_sound(state, m, &work->fault) || refuse_start(scene, &work->fault, message));
  if (ok)
    start_begin_drive(state, m);
  return ok && find_stream(scene, &origin, state, stream, message);
}

bool scene_start(struct scene *scene, struct state *state, struct work *work, struct stream *stream,
                 struct message *message)
{
  *stream = stream_of_seed(scene->seed);
  const bool ok = scene->snapshot
                      ? start_from_snapshot(scene, state, work, stream, message)
                      : start_state(state, &scene->model, work) || refuse_start(scene, &work->fault, message);
  scene->model.seed = stream->key;
  return ok;
}

/* The streams may meet, and the noise is drawn once more. */
static bool noise_returns(const struct stream *s)
{
  return s->from == STREAM_ASKED && s->parent_step > 0 && s->parent == s->key;
}

int start_warnings(const struct scene *scene, const struct stream *stream,
                   void (*tell)(void *context, const char *text), void *context)
{
  const struct {
    bool is;
    const char *text;
  } rows[] = {
      {noise_returns(stream),
       "start.stream: this seed is the stream of the run that made the snapshot, so its random numbers are drawn once "
       "more, and the two runs are not independent; use another seed, or start.stream: own"},
      {(stream->untold & UNTOLD_SLIDE) && model_is_sheared(&scene->model),
       "start.snapshot: the file does not say how far the images of the sheared box have slid: they begin without a "
       "slide, and particles near y = 0 and y = L may get other neighbors across the boundary; leave out what follows "
       "until they are forgotten"},
      {stream->untold & UNTOLD_BONDS,
       "start.snapshot: the file says nothing of bonds, so the scene's are taken, right or wrong: nothing tells rings "
       "from open fibers; use a file with connectivity/bonds"},
  };
  int told = 0;
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
    if (rows[k].is) {
      tell(context, rows[k].text);
      told++;
    }
  return told;
}

bool scene_has_room(const struct scene *scene, struct message *message)
{
  struct model alone = scene->model;
  struct state state;
  struct fault fault = {0};
  if (scene->snapshot || !start_is_crowded(&alone))
    return true;
  alone.solvent.particles = alone.dumbbells.pairs = 0;
  if (!state_alloc(&state, &alone))
    return message_no_memory(message, "%s: no memory to lay its fibers", scene->path);
  if (state.beads > 0)
    bead_start(&state, &alone);
  const bool ok = start_fibers(&state, &alone, NULL, &fault) || refuse_start(scene, &fault, message);
  state_free(&state);
  return ok;
}
