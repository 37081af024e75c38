/* Contacts of bonds: totals, and the rate since the row before. */
#include "observe/observer.h"

#include <math.h>
#include <string.h>

#include "theory/theory.h"

enum { LAST_STEP = 1, LAST_EXECUTED, INTEGERS };

static void size_collisions(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  (void)observer;
  (void)model;
  size->integers = INTEGERS;
}

static double ratio(double a, double b)
{
  return b > 0.0 ? a / b : 0.0;
}

static bool collisions_row(struct observer *observer, struct view *view, double *row)
{
  const struct collision_counts *c = &view->state->counts;
  const double executed = (double)c->executed;
  if (view->state->step == 0) /* no time has passed */
    return false;
  const double time = (double)((int64_t)view->state->step - observer->integer[LAST_STEP]) * view->model->time_step;
  const double new = (double)((int64_t)c->executed - observer->integer[LAST_EXECUTED]);
  const double values[] = {view_time(view),
                           (double)c->moves,
                           (double)c->possible,
                           executed,
                           (double)c->negative,
                           ratio(executed, (double)c->possible),
                           ratio(new, time * view->model->vertices),
                           observer->constant > 0.0 && time > 0.0 ? new / (time * observer->constant) : NAN,
                           (double)c->softened,
                           (double)c->rigid};
  memcpy(row, values, sizeof values);
  observer->integer[LAST_STEP] = (int64_t)view->state->step;
  observer->integer[LAST_EXECUTED] = (int64_t)c->executed;
  return true;
}

static const char *const columns[] = {"time",
                                      "moves",
                                      "possible",
                                      "executed",
                                      "negative",
                                      "executed_per_possible",
                                      "rate_per_vertex",
                                      "rate_over_theory",
                                      "softened",
                                      "rigid"};

const struct observer_type collisions_observer = {
    .column = columns,
    .columns = sizeof columns / sizeof *columns,
    .size = size_collisions,
    .constant = theory_contact_rate,
    .row = collisions_row,
};
