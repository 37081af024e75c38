// What operators of the solvent, of walls and of shear share.
#pragma once

#include "bodies.h"
#include "operators.h"

// Particles and vertices on the machine that computes.
struct Members {
  State state;
  int64_t n, vertices, cell_count;
  Array<int64_t> place[3];
  Array<double> velocity[3];
  Array<uint32_t> id;
  Array<Point> vertex;
  Array<Vector> vertex_velocity;
  Array<double> mass;

  Members(const Model &model, State given) : state(std::move(given)), cell_count(model.cell_count())
  {
    const size_t count = state.solvent.size(), of_fibers = state.vertex.size();
    n = (int64_t)count, vertices = (int64_t)of_fibers;
    for (int axis = 0; axis < 3; axis++)
      place[axis].resize(count), velocity[axis].resize(count);
    id.resize(count), vertex.resize(of_fibers), vertex_velocity.resize(of_fibers), mass.resize(of_fibers);
    upload_columns(place, velocity, id, state);
    vertex.upload(state.vertex.data(), of_fibers);
    vertex_velocity.upload(state.vertex_velocity.data(), of_fibers);
    mass.upload(model.mass.data(), of_fibers);
  }

  Columns columns()
  {
    return {place[0].data(),    place[1].data(),    place[2].data(), velocity[0].data(),
            velocity[1].data(), velocity[2].data(), id.data()};
  }

  void fetch()
  {
    download_columns(place, velocity, id, state);
    vertex_velocity.download(state.vertex_velocity.data(), state.vertex_velocity.size());
  }
};

void write_sums(Writer &out, const std::vector<CellSum> &sums);
// Tables `active`, `center`, `axis` and `factor`; `filled`.
std::vector<CellTurn> turns_of(const OperatorInput &in);
std::vector<Virtual> filled_of(const OperatorInput &in);
