#include "observe/units.h"

#include <stdio.h>
#include <string.h>

#include "observe/meaning.h"

/* The columns of an observable that share a unit, separated by blanks. */
static const struct {
  enum observable of;
  const char *unit, *columns;
} units[] = {
    {OBSERVE_CONSERVED, "t0", "time"},
    {OBSERVE_CONSERVED, "kT", "solvent_kinetic vertex_kinetic bond bend pairs total"},
    {OBSERVE_CONSERVED, "m a0/t0", "px py pz"},
    {OBSERVE_TEMPERATURE, "t0", "time"},
    {OBSERVE_TEMPERATURE, "kT", "solvent solvent_x solvent_y solvent_z vertex vertex_half_step"},
    {OBSERVE_STATICS, "a0", "l lp"},
    {OBSERVE_STATICS, "a0^2", "l2 Ree2 Rg2"},
    {OBSERVE_STATICS, "kT", "bond_energy bend_energy"},
    {OBSERVE_STATICS, "1", "cos samples"},
    {OBSERVE_DYNAMICS, "t0", "time"},
    {OBSERVE_DYNAMICS, "a0^2", "g g_cm g_middle d2 d2_contour d2_third g_cm_about_mean"},
    {OBSERVE_DYNAMICS, "a0^2/t0", "D D_about_mean D_cumulative D_cumulative_about_mean"},
    {OBSERVE_DYNAMICS, "a0/t0", "drift_x drift_y drift_z"},
    {OBSERVE_DYNAMICS, "1", "end_to_end end_to_end_unit axis_unit intervals"},
    {OBSERVE_COLLISIONS, "t0", "time"},
    {OBSERVE_COLLISIONS, "1", "moves possible executed negative executed_per_possible rate_over_theory softened rigid"},
    {OBSERVE_COLLISIONS, "1/t0", "rate_per_vertex"},
    {OBSERVE_PROFILE, "a0", "y"},
    {OBSERVE_PROFILE, "m/a0^3", "density"},
    {OBSERVE_PROFILE, "a0/t0", "vx vy vz vx_in_phase vx_out_of_phase"},
    {OBSERVE_PROFILE, "kT", "temperature"},
    {OBSERVE_PROFILE, "1", "samples"},
    {OBSERVE_STRESS, "t0", "time"},
    {OBSERVE_STRESS, "kT/a0^3",
     "sigma_xy sigma_xy_kinetic sigma_xy_collisional N1 pressure sigma_lower sigma_upper sigma_xy_spring N1_spring "
     "sigma_xy_fibers N1_fibers sigma_xy_contacts N1_contacts"},
    {OBSERVE_DUMBBELLS, "a0^2", "r2 rxrx ryry rzrz rxry"},
    {OBSERVE_DUMBBELLS, "1", "extension samples"},
    {OBSERVE_DUMBBELLS, "degrees", "chi"},
    {OBSERVE_ORIENTATION, "a0^2", "RxRx RyRy RzRz RxRy"},
    {OBSERVE_ORIENTATION, "1", "uxux uyuy uzuz uxuy S samples"},
    {OBSERVE_ORIENTATION, "degrees", "chi"},
    {OBSERVE_ORIENTATION, "1/t0", "turning"},
    {OBSERVE_BEAD, "t0", "time"},
    {OBSERVE_BEAD, "a0", "place_x place_y place_z trap_x trap_y trap_z"},
    {OBSERVE_BEAD, "a0/t0", "velocity_x velocity_y velocity_z"},
    {OBSERVE_BEAD, "kT/a0", "force_x force_y force_z"},
    {OBSERVE_BEAD, "kT", "work heat"},
    {OBSERVE_BEAD, "1", "hits"},
    {OBSERVE_MEMORY, "t0", "time"},
    {OBSERVE_MEMORY, "kT/m", "vertices center"},
    {OBSERVE_MEMORY, "(kT)^2", "stress_memory"},
    {OBSERVE_MEMORY, "1", "intervals"},
    {OBSERVE_PRESSURE, "t0", "time"},
    {OBSERVE_PRESSURE, "kT/a0^3", "pressure p_xx p_yy p_zz p_xy pressure_contacts"},
    {OBSERVE_PRESSURE, "kT", "potential configurational"},
    {OBSERVE_PRESSURE, "(kT/a0)^2", "force_square"},
    {OBSERVE_PRESSURE, "kT/a0^2", "laplacian"},
    {OBSERVE_WAKE, "a0", "distance along away"},
    {OBSERVE_WAKE, "1", "cosine samples"},
    {OBSERVE_WAKE, "1/a0^3", "number"},
    {OBSERVE_TOPOLOGY, "1", "intervals looked_at crossed net odd_pairs unsure"},
    {OBSERVE_TOPOLOGY, "1/t0", "rate"},
    {OBSERVE_TOPOLOGY, "t0", "first_time last_time"},
};

enum { UNITS = sizeof units / sizeof *units, LONGEST_NAME = 64 };

/* The next word of a list, which it leaves behind; false at the end. */
static bool next_word(const char **list, char word[LONGEST_NAME])
{
  const size_t length = strcspn(*list, " ");
  snprintf(word, LONGEST_NAME, "%.*s", (int)length, *list);
  *list += length + ((*list)[length] == ' ');
  return length > 0;
}

const char *observe_unit(const char *column)
{
  char name[LONGEST_NAME], word[LONGEST_NAME];
  snprintf(name, sizeof name, "%s", column);
  char *error = strstr(name, "_error");
  if (error && strcmp(error, "_error") == 0)
    *error = '\0';
  for (size_t k = 0; k < UNITS; k++)
    for (const char *list = units[k].columns; next_word(&list, word);)
      if (strcmp(word, name) == 0)
        return units[k].unit;
  return NULL;
}

void observe_units(const struct observe_plan *plan, const struct model *model,
                   void (*tell)(void *context, const char *column, const char *unit), void *context)
{
  char word[LONGEST_NAME];
  for (size_t k = 0; k < UNITS; k++)
    for (const char *list = units[k].columns; plan->every[units[k].of] > 0 && next_word(&list, word);)
      if (meaning_has_column(model, units[k].of, word))
        tell(context, word, units[k].unit);
}
