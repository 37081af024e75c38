#include "theory/flow.h"

#include "theory/bead.h"
#include "theory/dumbbell.h"
#include "theory/load.h"
#include "theory/theory.h"

static const double pi = 3.14159265358979323846;

double theory_slip_length(const struct collision_rule *rule, uint32_t d, double gamma, double cosine, double interval)
{
  const double loss = 1.0 - theory_vertex_retention(rule, d, 1.0, gamma, cosine);
  return THEORY_MILNE_SLIP - sqrt(2.0 / pi) * interval / loss;
}

double theory_couette_rate(double wall_rate, double height, double slip)
{
  return wall_rate / (1.0 + 2.0 * slip / height);
}

double theory_poiseuille_speed(double mass_density, double acceleration, double height, double viscosity, double slip)
{
  return mass_density * acceleration * height * height / (8.0 * viscosity) * (1.0 + 4.0 * slip / height);
}

double theory_flow_relaxation(double height, double kinematic_viscosity)
{
  return height * height / (pi * pi * kinematic_viscosity);
}

/* Of momentum alone. */
static double transient_of_flow(const struct model *model, double kinematic_viscosity)
{
  const struct vec3 sum = vec3_add(model->walls.lower, model->walls.upper);
  const bool pulled = vec3_norm(model->solvent.acceleration) > 0.0;
  const bool slides = vec3_norm(model->walls.lower) + vec3_norm(model->walls.upper) > 0.0;
  const double even = theory_flow_relaxation(model->box.cells[1], kinematic_viscosity), odd = 0.25 * even;
  if (model->solvent.profile != PROFILE_UNIFORM)
    return odd;
  if (model->walls.kind != WALL_NO_SLIP || !(pulled || slides))
    return 0.0;
  return pulled || vec3_norm(sum) > 0.0 ? even : odd;
}

double theory_flow_transient(const struct model *model, double kinematic_viscosity)
{
  const double flow = transient_of_flow(model, kinematic_viscosity);
  const bool stretches = model_has_dumbbells(model) && (flow > 0.0 || model_is_sheared(model));
  return stretches ? fmax(flow, 1.0 / theory_model_dumbbell_rate(model)) : flow;
}

double theory_penetration_depth(double frequency, double kinematic_viscosity)
{
  return sqrt(2.0 * kinematic_viscosity / frequency);
}

double theory_inertia_number(double frequency, double mass_density, double height, double viscosity)
{
  return frequency * mass_density * height * height / (8.0 * viscosity);
}

double theory_flow_heating(double viscosity, double rate, double mass_density, uint32_t dimensions)
{
  return 2.0 * viscosity * rate * rate / (dimensions * mass_density);
}

double theory_profile_speed(enum force_profile profile, double mass_density, double acceleration, double height,
                            double viscosity)
{
  static const double share[PROFILES] = {
      [PROFILE_SINE] = 0.02533029591058444 /* 1/(4 pi^2) */, [PROFILE_REVERSE] = 1.0 / 32.0};
  return share[profile] * mass_density * acceleration * height * height / viscosity;
}

double theory_profile_reynolds(double speed, double height, double kinematic_viscosity)
{
  return speed * height / (6.283185307179586 * kinematic_viscosity);
}

double theory_mean_shear_rate(const struct model *model)
{
  return fabs(model->shear.rate) * (model->shear.period > 0.0 ? sqrt(0.5) : 1.0);
}

/* By the force on the solvent: what the force of half a channel needs, L/2 high, L/4 where it changes sign; rho g/(eta
 * k) of a sine. */
static double rate_of_force(const struct model *model)
{
  static const double height[PROFILES] = {
      [PROFILE_UNIFORM] = 0.5, [PROFILE_SINE] = 0.15915494309189535 /* 1/(2 pi) */, [PROFILE_REVERSE] = 0.25};
  const struct solvent_model *s = &model->solvent;
  if (vec3_norm(s->acceleration) == 0.0 || (s->profile == PROFILE_UNIFORM && model->walls.kind != WALL_NO_SLIP))
    return 0.0;
  return height[s->profile] * model->box.cells[1] * s->per_cell * vec3_norm(s->acceleration) /
         theory_loaded_viscosity(model);
}

/* Of all but the bead. */
static double rate_of_flow(const struct model *model)
{
  const bool drags = model->walls.kind == WALL_NO_SLIP;
  const double slide = drags ? vec3_norm(vec3_sub(model->walls.upper, model->walls.lower)) / model->box.cells[1] : 0.0;
  return fabs(model->shear.rate) + slide + rate_of_force(model);
}

/* V of a bead that is pulled, by its force or by its trap. */
static double bead_speed(const struct model *model)
{
  const struct bead_drive *d = &model->bead.drive;
  const double swing = d->period > 0.0 ? vec3_norm(d->amplitude) * 2.0 * pi / d->period : 0.0;
  return vec3_norm(d->force) / theory_model_bead_friction(model) + vec3_norm(d->velocity) + swing;
}

struct theory_shear theory_shear_of(const struct model *model)
{
  const double radius = model->bead.radius;
  if (!model_has_solvent(model))
    return (struct theory_shear){.radius = radius};
  struct theory_shear s = {rate_of_flow(model), radius > 0.0 ? bead_speed(model) : 0.0, radius, 0.0, 0.0};
  if (s.rate + s.bead > 0.0) {
    s.sound = theory_sound_speed(model_is_isothermal(model), model->dimensions);
    s.kinematic = theory_loaded_kinematic(model);
  }
  return s;
}

double theory_shear_speed(const struct theory_shear *s, double distance)
{
  return s->rate * distance + (s->bead > 0.0 ? s->bead * fmin(distance / s->radius, 1.0) : 0.0);
}
