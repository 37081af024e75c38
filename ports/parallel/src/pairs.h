// Pairs of bonds that are near each other, kept over many drifts. A list has all pairs, with their images, that were
// closer than the skin at its reference: while no vertex is further than half the skin from where it was then, no other
// pair can touch.
#pragma once

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

class PairList
{
public:
  explicit PairList(const Model &model) : model(model)
  {
  }

  void build(const std::vector<Point> &position, double skin);
  // Square of the distance that this place of a vertex has from its reference, a0.
  double moved(int32_t vertex, Point place) const
  {
    const Vector d = in_a0(place - reference[(size_t)vertex]);
    return dot(d, d);
  }

  bool built = false;
  double skin = 0;
  std::vector<Pair> pairs;
  std::vector<int32_t> first; // of the entries of each bond in `near`
  std::vector<Near> near;

private:
  void find(const std::vector<int32_t> &bonds);
  void find_by_cells(const std::vector<int32_t> &bonds, const int64_t cells[3]);
  void find_around(const struct Sorted &s, size_t k, const int64_t cells[3], std::vector<Pair> &found) const;
  void add_pair(int32_t bond, int32_t other, Point image, std::vector<Pair> &found) const;
  void add_images(int32_t bond, int32_t other, double reach, std::vector<Pair> &found) const;
  void index();

  const Model &model;
  std::vector<Point> reference, middle; // of vertices, of bonds
};

// The distance of two bonds p and q, w from the first vertex of one to that of the other.
double bond_distance(Vector p, Vector q, Vector w);
