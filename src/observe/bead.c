/* The bead: where it is, how fast, what pulls it, and its accounts. Numbers of the time of the step. */
#include <math.h>
#include <string.h>

#include "observe/observer.h"
#include "system/bead.h"

static bool bead_row(struct observer *observer, struct view *view, double *row)
{
  (void)observer;
  const struct model *m = view->model;
  const struct bead *b = view->state->bead;
  const bool trap = m->bead.drive.spring > 0.0;
  const uint64_t now = view->state->solvent_time;
  const struct vec3 x = point_in_a0(b->position), v = bead_velocity_now(view->state, m),
                    f = bead_force(m, b->position, now), c = bead_trap(m, now);
  const double values[] = {view_time(view),
                           x.x,
                           x.y,
                           x.z,
                           v.x,
                           v.y,
                           v.z,
                           f.x,
                           f.y,
                           f.z,
                           trap ? c.x : NAN,
                           trap ? c.y : NAN,
                           trap ? c.z : NAN,
                           (double)b->account.y * BEAD_ENERGY_UNIT,
                           (double)b->account.x * BEAD_ENERGY_UNIT,
                           (double)b->account.z};
  memcpy(row, values, sizeof values);
  return true;
}

static const char *const columns[] = {"time",       "place_x", "place_y", "place_z", "velocity_x", "velocity_y",
                                      "velocity_z", "force_x", "force_y", "force_z", "trap_x",     "trap_y",
                                      "trap_z",     "work",    "heat",    "hits"};

const struct observer_type bead_observer = {
    .column = columns,
    .columns = sizeof columns / sizeof *columns,
    .row = bead_row,
};
