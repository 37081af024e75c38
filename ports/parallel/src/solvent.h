// The solvent and the collisions, on the machine of device.h. Particles lie in memory in about the order of their
// cells.
#pragma once

#include "borders.h"
#include "device.h"
#include "model.h"

// What the members of a cell add up to. `load`: members times 2^44, plus the mass in 2^-16 m.
struct CellSum {
  int64_t x, y, z, load;
};

struct alignas(64) CellTurn {
  Vector center, axis;
  double factor;
  int64_t active;
};

constexpr int load_bits = 44;

struct Columns {
  int64_t *x, *y, *z;
  double *vx, *vy, *vz;
  uint32_t *id;
};

struct Grid {
  int64_t cells[3];
  Point edge, shift; // of all cells: between walls there is one more along y
};

// What fills a cut cell: so many virtual particles of mass 1, and the mean of their velocities.
struct Virtual {
  double number;
  Vector velocity;
};

struct Settings {
  int sort_every = 64;     // collisions between two sortings
  int transposed = 1;      // on a GPU: neighbors in a warp add the four numbers of one particle together
  bool one_by_one = false; // on a CPU: loops over single particles, as on a GPU
  bool fused = true;       // turn and the next flight in one pass
};

// Solvent by ids into columns, and back.
void upload_columns(Array<int64_t> *place, Array<double> *velocity, Array<uint32_t> &id, const State &state);
void download_columns(const Array<int64_t> *place, const Array<double> *velocity, const Array<uint32_t> &id,
                      State &state);
// The factor of `rescale`: of each copy of the totals members - 1, relative / 2^32, relative mod 2^32.
double rescale_factor(const Array<int64_t> &total);
Point grid_shift(const Model &model, uint64_t step);
Grid grid_of(const Model &model, Point shift);
// What fills cut cells in the collision of a step; sums and `filled` are the caller's.
struct FillCell filling_of(const Model &model, const WallPair &wall, Point shift, uint64_t step);

class Solvent
{
public:
  Solvent(const Model &model, const State &state, const Settings &settings);

  // The collision of a step; the solvent flies for `time` before. Velocities of vertices change.
  void collide(uint64_t step, double time, State &state);
  // Begins the flight to the next collision, which must come without a fetch in between: a GPU flies while the host
  // works on the vertices.
  void fly_ahead(uint64_t step, double time);
  // Solvent by ids into the state.
  void fetch(State &state);

private:
  Columns columns();
  template <class Use> void with_border(uint64_t step, Use use);
  template <class Border> void pass(const Border &border, double time, const Grid &next);
  void fly_and_sum(uint64_t step, double time, const Grid &next);
  Image image_at(uint64_t step, Point shift) const;
  void fill_cut_cells(uint64_t step);
  void solve(uint64_t step);
  void apply_thermostat(uint64_t step);
  void collide_drawn(uint64_t step);
  void finish_turn();
  void sort();
  void swap_velocities(uint64_t step);
  void take_vertices(State &state);
  void give_vertices(State &state) const;
  void sum_vertices(const Grid &next);
  void turn_vertices();

  const Model &model;
  Settings settings;
  int64_t n, cell_count;
  int shards;
  bool pending = false; // velocities are those of before the collision; `turn` has what is left to be done
  bool ahead = false;   // the flight to the next collision has begun
  int64_t since_sort = 0;
  Grid at_collision = {};
  uint64_t last_step = 0; // of the last collision
  Array<int64_t> place[3], sorted_place[3], count, relative, total;
  Array<double> velocity[3], sorted_velocity[3];
  Array<uint32_t> id, sorted_id;
  Array<int32_t> cell; // of each particle at the last collision, for the passes of columns.h
  Array<CellSum> sums;
  Array<CellTurn> turn;
  // Where vertices are in this collision: on a GPU copies.
  struct {
    Point *p = nullptr;
    Vector *v = nullptr;
    const double *mass = nullptr;
    int64_t n = 0;
  } vertices;
  Array<Point> vertex;
  Array<Vector> vertex_velocity;
  Array<int32_t> vertex_cell; // at the last collision, for columns.h
  Array<double> vertex_mass;
  Array<Virtual> filled;   // walls: what fills cut cells
  Array<int64_t> given;    // walls: their account
};
