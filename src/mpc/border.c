#include "mpc/border.h"

#include "mpc/grid.h"

const struct border border_periodic = {
    .name = "periodic", .bin_particles = grid_bin_particles, .bin_vertices = grid_bin_vertices};

const struct border *border_of(const struct model *model)
{
  static const struct border *const borders[BOUNDARIES] = {
      [BOUNDARY_PERIODIC] = &border_periodic, [BOUNDARY_WALL] = &border_walls, [BOUNDARY_SHEAR] = &border_sheared};
  return borders[model->box.boundary[1]];
}
