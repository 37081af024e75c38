/*
 * Fibers without solvent, N steps, velocities reversed, N steps back (reversal.h): how far they miss their start.
 *
 * usage: reversal CELLS FIBERS VERTICES KAPPA DT SEED STEPS...
 *
 * Columns: contacts there and back; largest miss of a vertex, a0 and a0/t0. Then each drift with contacts reversed by
 * itself: how many there are; of those whose contacts all return to the same tick, and of the others, their number and
 * the largest miss; number of drifts by their latest contact, in ticks; with other contacts; rigid clusters; softened
 * rebounds, there and back.
 */
#include "reversal.h"

int main(int argc, char **argv)
{
  if (argc < 8) {
    fprintf(stderr, "usage: %s CELLS FIBERS VERTICES KAPPA DT SEED STEPS...\n", argv[0]);
    return 2;
  }
  struct reversal_setup s = {.cells = atoi(argv[1]),
                             .fibers = (uint32_t)atoi(argv[2]),
                             .vertices = (uint32_t)atoi(argv[3]),
                             .kappa = atof(argv[4]),
                             .dt = atof(argv[5]),
                             .seed = strtoull(argv[6], NULL, 10)};
  puts("steps,dt,contacts,contacts_back,position_miss,velocity_miss,drifts,same,same_position,same_velocity,others,"
       "others_position,others_velocity,late1,late2,late3,late4,late5,later,other_contacts,rigid,softened");
  for (int a = 7; a < argc; a++) {
    s.steps = strtoull(argv[a], NULL, 10);
    const struct reversal r = reversal_measure(&s);
    printf("%llu,%g,%zu,%zu,%.3g,%.3g,%llu,%llu,%.3g,%.3g,%llu,%.3g,%.3g", (unsigned long long)s.steps, s.dt,
           r.contacts, r.contacts_back, r.whole.position, r.whole.velocity, (unsigned long long)r.drifts,
           (unsigned long long)r.same, r.of_same.position, r.of_same.velocity,
           (unsigned long long)(r.later_ones + r.different), r.of_others.position, r.of_others.velocity);
    for (int k = 1; k < 7; k++)
      printf(",%llu", (unsigned long long)r.late[k]);
    printf(",%llu,%llu,%llu\n", (unsigned long long)r.late[0], (unsigned long long)r.rigid,
           (unsigned long long)r.softened);
    fflush(stdout);
  }
  return 0;
}
