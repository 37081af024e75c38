/* What verdicts say about each observable, and where a difference in it comes from. The last row fits all others. */
#include <string.h>

#include "oracle/judge.h"

#define ENERGY "energy drifts by", "% per t0"
#define MOMENTUM "total momentum changes in a block by", "sqrt(3 M kT)"
#define COLLISIONS "who is summed and who is turned in a cell, masses in the sums, one center for all members of a cell"

static const struct observable_words words[] = {
    {"viscosity", "it is", "", "grid shift, rotation angle, collision interval", 1.0},
    {"solvent_memory", "it is", "", "rotation angle, members of cells", 1.0},
    {"solvent_diffusion", "it is", "", "grid shift, streaming", 1.0},
    {"wave_energy_drift", ENERGY, "length of the rotation axis, cosine and sine of the angle, " COLLISIONS, 100.0},
    {"wave_momentum_change", MOMENTUM, COLLISIONS, 1.0},
    {"vertex_diffusion", "it is", "", "mass and coupling of vertices, hydrodynamic interactions", 1.0},
    {"temperature", "it is", "kT", "target of the thermostat, 3(N - 1) degrees of freedom", 1.0},
    {"vertex_temperature", "it is", "kT", "mass of vertices in collisions", 1.0},
    {"vertex_momentum_change", MOMENTUM, COLLISIONS ", thermostat about the velocity of the cell", 1.0},
    {"vertex_diffusion_swap", "it is", "", "swap of velocities, coupling of vertices", 1.0},
    {"swap_momentum_change", MOMENTUM, "a swap that is a permutation, " COLLISIONS, 1.0},
    {"bond_length", "it is", "a0", "springs, impulses on bonds", 1.0},
    {"bond_variance", "it is", "a0^2", "springs, impulses on bonds", 1.0},
    {"bend_cosine", "it is", "", "bends", 1.0},
    {"end_to_end_square", "it is", "a0^2", "bends, a constraint that excludes volume", 1.0},
    {"chain_displacement", "it is", "a0^2", "friction between fibers, coupling of vertices", 1.0},
    {"crossing_rate", "it is", "per vertex and t0", "images, search for crossings, exchange", 1.0},
    {"hidden_share", "it is", "", "crossings after the first of a move: found, and not executed", 1.0},
    {"negative_share", "it is", "", "clipping, sign and normal of the exchange", 1.0},
    {"crossing_heat", "it is", "kT per rejected move", "order of drift, collision and kick; energy of the exchange",
     1.0},
    {"energy_drift", ENERGY, "energy of the exchange, order of drift, collision and kick, length of the rotation axis",
     100.0},
    {"fiber_momentum_change", MOMENTUM, "impulses on both bonds of an exchange, forces that add up to 0, " COLLISIONS,
     1.0},
    {"", "it is", "", "", 1.0},
};

const struct observable_words *observable_words_of(const char *name)
{
  const size_t last = sizeof words / sizeof *words - 1;
  size_t k = 0;
  while (k < last && strcmp(words[k].name, name) != 0)
    k++;
  return &words[k];
}
