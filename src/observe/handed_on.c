#include "observe/handed_on.h"

#include <string.h>

#include "observe/meaning.h"

/* Doubles alone: it is saved in checkpoints as it is. Sums are whole numbers of FLUX_UNIT kT t0, exact below 2^25 kT
 * t0, so that the order of contacts does not matter. */
struct handed_on {
  double sum[STRESS_COMPONENTS];
  double since; /* step of the row before */
};

void handed_on_size(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  (void)observer;
  size->later += meaning_holds(THICK, model) ? sizeof(struct handed_on) / sizeof(double) : 0;
}

void handed_on_add(struct observer *observer, const struct contact_event *event)
{
  struct handed_on *h = (struct handed_on *)observer->later;
  const struct vec3 n = event->hit.normal, way = vec3_scale(event->impulse * event->gap, n);
  h->sum[STRESS_XY] += (double)flux_fixed(way.x * n.y);
  h->sum[STRESS_XX] += (double)flux_fixed(way.x * n.x);
  h->sum[STRESS_YY] += (double)flux_fixed(way.y * n.y);
  h->sum[STRESS_ZZ] += (double)flux_fixed(way.z * n.z);
}

bool handed_on_mean(struct observer *observer, const struct view *view, double mean[STRESS_COMPONENTS])
{
  struct handed_on *h = (struct handed_on *)observer->later;
  memset(mean, 0, STRESS_COMPONENTS * sizeof *mean);
  if (observer->size.later == 0)
    return true;
  const double step = (double)view->state->step, passed = (step - h->since) * view->model->time_step;
  if (passed == 0.0)
    return false;
  for (int k = 0; k < STRESS_COMPONENTS; k++)
    mean[k] = FLUX_UNIT * h->sum[k] / passed;
  *h = (struct handed_on){.since = step};
  return true;
}
