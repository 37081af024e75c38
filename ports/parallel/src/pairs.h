// Pairs of bonds that are near each other, kept over many drifts. A list has all pairs, with their images, that were
// closer than the skin at its reference: while no vertex is further than half the skin from where it was then, no other
// pair can touch.
#pragma once

#include <cmath>
#include <vector>

#include "model.h"

struct Near {
  int32_t other; // bond
  int32_t image[3];
  int32_t pair; // number of the pair: both its bonds have it
};

struct Pair {
  int32_t bond, other; // bond < other, whose image it is
  int32_t image[3];
};

// Vectors of pairs in columns, which compilers turn into vector instructions: p, q, w of each, a0.
constexpr int pair_lanes = 64;
struct PairColumns {
  int count = 0;
  int32_t number[pair_lanes];
  alignas(64) double p[3][pair_lanes], q[3][pair_lanes], w[3][pair_lanes], apart[pair_lanes];

  void add(int32_t its_number, Vector its_p, Vector its_q, Vector its_w)
  {
    number[count] = its_number;
    p[0][count] = its_p.x, p[1][count] = its_p.y, p[2][count] = its_p.z;
    q[0][count] = its_q.x, q[1][count] = its_q.y, q[2][count] = its_q.z;
    w[0][count] = its_w.x, w[1][count] = its_w.y, w[2][count] = its_w.z;
    count++;
  }
  // Fills `apart`: distances of bonds, wrong by less than 1e-7 of their lengths.
  void measure();
};

class PairList
{
public:
  explicit PairList(const Model &model);
  ~PairList();

  void build(const std::vector<Point> &position, double skin);
  // Square of the distance that this place of a vertex has from its reference, a0.
  double moved(int32_t vertex, Point place) const
  {
    const Vector d = in_a0(place - reference[vertex]);
    return dot(d, d);
  }

  bool built = false;
  double skin = 0;
  std::vector<Pair> pairs;
  std::vector<double> apart;  // of each pair at its reference
  std::vector<int32_t> first; // of the entries of each bond in `near`
  std::vector<Near> near;

private:
  struct Sorted;
  struct Waiting;
  struct Found;
  struct Run;
  void find();
  void sort_bonds(Sorted &s) const;
  int runs_around(const Sorted &s, int64_t x, int64_t y, int64_t z, Run *runs) const;
  void find_around(const Sorted &s, int64_t cell, Found &found) const;
  void look(const Sorted &s, int32_t k, const Run &run, Vector shift, float reach, Found &found) const;
  void find_images(const Sorted &s, int32_t k, int32_t l, double reach, Found &found) const;
  void add(const Sorted &s, const Waiting &pair, Vector shift, Found &found) const;
  void keep_near(const Sorted &s, Found &found) const;
  void gather();
  void index();

  const Model &model;
  std::vector<int32_t> bonds, index_next;
  std::vector<Point> reference, middle;
  std::vector<Found> found;
};
