#include "system/shear.h"

#include <stdlib.h>

#include "base/elementary.h"

double shear_wave(const struct model *m, uint64_t half_intervals)
{
  const struct wave *w = &m->wave;
  return w->intervals ? w->cosine[half_intervals % (2 * (uint64_t)w->intervals)] : 1.0;
}

double shear_rate(const struct model *m, uint64_t interval)
{
  return model_is_sheared(m) ? m->shear.rate * shear_wave(m, 2 * interval + 1) : 0.0;
}

uint64_t shear_slide(const struct model *m, uint64_t interval)
{
  const double displacement = shear_rate(m, interval) * m->box.cells[1] * 0.5 * m->time_step;
  return (uint64_t)lattice_fold(lattice_from_a0(displacement), m->box.edge[0]);
}

bool shear_finish(struct model *m)
{
  struct wave *w = &m->wave;
  if (w->intervals == 0)
    return true;
  const uint64_t edge = (uint64_t)m->box.edge[0];
  w->cosine = calloc(2 * (size_t)w->intervals, sizeof *w->cosine);
  w->slid = calloc((size_t)w->intervals + 1, sizeof *w->slid);
  if (!w->cosine || !w->slid)
    return false;
  for (uint32_t k = 0; k < 2 * w->intervals; k++)
    w->cosine[k] = elementary_circle_turns(0.5 * k / w->intervals).cosine;
  for (uint32_t k = 0; k < w->intervals; k++)
    w->slid[k + 1] = (w->slid[k] + shear_slide(m, k)) % edge;
  return true;
}
