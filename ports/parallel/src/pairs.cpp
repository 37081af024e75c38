#include "pairs.h"

#include <algorithm>

// Square of the distance of the origin from the segment from `from` along `along`.
static double square_from_segment(Vector from, Vector along)
{
  const double length = dot(along, along);
  double s = length > 0.0 ? -dot(from, along) / length : 0.0;
  s = s < 0.0 ? 0.0 : s > 1.0 ? 1.0 : s;
  const Vector gap = from + s * along;
  return dot(gap, gap);
}

double bond_distance(Vector p, Vector q, Vector w)
{
  double least = std::min(std::min(square_from_segment(w, q), square_from_segment(w - p, q)),
                          std::min(square_from_segment(-w, p), square_from_segment(-(w + q), p)));
  const Vector n = cross(p, q);
  const double nn = dot(n, n), pp = dot(p, p), qq = dot(q, q);
  if (nn > 1e-20 * (pp * qq)) { // lines: s p - t q = w within n's plane
    const double s = dot(cross(w, q), n) / nn, t = dot(cross(w, p), n) / nn;
    if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) {
      const double along = dot(w, n);
      least = std::min(least, along * along / nn);
    }
  }
  return std::sqrt(least);
}

static int64_t floor_divide(int64_t a, int64_t b)
{
  return a / b - (a % b < 0);
}

// All images of the other bond that are closer than the skin.
void PairList::add_images(int32_t bond, int32_t other, double reach, std::vector<Pair> &found) const
{
  const size_t i = (size_t)bond, j = (size_t)other, i1 = (size_t)model.next[i], j1 = (size_t)model.next[j];
  if (i == j || i == j1 || i1 == j || i1 == j1)
    return;
  const Point w = reference[j] - reference[i], between = middle[j] - middle[i], edge = model.edge();
  const int64_t far = (int64_t)(reach * lattice_per_a0);
  const int64_t apart[3] = {between.x, between.y, between.z}, edges[3] = {edge.x, edge.y, edge.z};
  int64_t low[3], high[3];
  for (int axis = 0; axis < 3; axis++) { // |apart + k edge| <= far
    low[axis] = -floor_divide(apart[axis] + far, edges[axis]);
    high[axis] = floor_divide(far - apart[axis], edges[axis]);
    if (low[axis] > high[axis])
      return;
  }
  const Vector p = in_a0(reference[i1] - reference[i]), q = in_a0(reference[j1] - reference[j]);
  for (int64_t x = low[0]; x <= high[0]; x++)
    for (int64_t y = low[1]; y <= high[1]; y++)
      for (int64_t z = low[2]; z <= high[2]; z++) {
        const Point shift = {x * edge.x, y * edge.y, z * edge.z};
        const Vector at = in_a0(between + shift);
        if (dot(at, at) <= reach * reach && bond_distance(p, q, in_a0(w + shift)) < skin)
          found.push_back({bond, other, {(int32_t)x, (int32_t)y, (int32_t)z}});
      }
}

// Cells at least as wide as the reach of a bond's middle: partners are in the 27 cells around.
void PairList::find_by_cells(const std::vector<int32_t> &bonds, const int64_t cells[3], double reach)
{
  const Point edge = model.edge();
  const auto cell_along = [](int64_t x, int64_t edge, int64_t n) {
    const int64_t folded = x - floor_divide(x, edge) * edge;
    return std::min((int64_t)((double)folded / (double)edge * (double)n), n - 1);
  };
  std::vector<int32_t> start((size_t)(cells[0] * cells[1] * cells[2] + 1), 0), sorted(bonds.size());
  std::vector<int64_t> cell_of(3 * bonds.size());
  for (size_t k = 0; k < bonds.size(); k++) {
    const Point r = middle[(size_t)bonds[k]];
    cell_of[3 * k] = cell_along(r.x, edge.x, cells[0]);
    cell_of[3 * k + 1] = cell_along(r.y, edge.y, cells[1]);
    cell_of[3 * k + 2] = cell_along(r.z, edge.z, cells[2]);
  }
  const auto number = [&](int64_t x, int64_t y, int64_t z) { return (size_t)((z * cells[1] + y) * cells[0] + x); };
  const auto number_of = [&](size_t k) { return number(cell_of[3 * k], cell_of[3 * k + 1], cell_of[3 * k + 2]); };
  for (size_t k = 0; k < bonds.size(); k++)
    start[number_of(k) + 1]++;
  for (size_t c = 1; c < start.size(); c++)
    start[c] += start[c - 1];
  std::vector<int32_t> next(start.begin(), start.end() - 1);
  for (size_t k = 0; k < bonds.size(); k++)
    sorted[(size_t)next[number_of(k)]++] = bonds[k];
  std::vector<std::vector<Pair>> parts(64); // in the order of the bonds, whoever finds them
#pragma omp parallel for schedule(dynamic)
  for (size_t part = 0; part < parts.size(); part++)
    for (size_t k = part * bonds.size() / parts.size(); k < (part + 1) * bonds.size() / parts.size(); k++)
      for (int64_t n = 0; n < 27; n++) {
        const int64_t x = (cell_of[3 * k] + n % 3 + cells[0] - 1) % cells[0];
        const int64_t y = (cell_of[3 * k + 1] + n / 3 % 3 + cells[1] - 1) % cells[1];
        const int64_t z = (cell_of[3 * k + 2] + n / 9 + cells[2] - 1) % cells[2];
        const size_t cell = number(x, y, z);
        for (int32_t m = start[cell]; m < start[cell + 1]; m++)
          if (sorted[(size_t)m] > bonds[k])
            add_images(bonds[k], sorted[(size_t)m], reach, parts[part]);
      }
  for (const std::vector<Pair> &part : parts)
    pairs.insert(pairs.end(), part.begin(), part.end());
}

void PairList::find(const std::vector<int32_t> &bonds)
{
  double longest = 0.0;
  middle.resize(reference.size());
  for (const int32_t bond : bonds) {
    const Point a = reference[(size_t)bond], r = reference[(size_t)model.next[(size_t)bond]] - a;
    longest = std::max(longest, dot(in_a0(r), in_a0(r)));
    middle[(size_t)bond] = a + Point{r.x / 2, r.y / 2, r.z / 2};
  }
  const double reach = std::sqrt(longest) + skin + 1e-6; // of middles
  int64_t cells[3];
  bool wide = true;
  for (int axis = 0; axis < 3; axis++) {
    cells[axis] = (int64_t)((double)model.cells[axis] / reach);
    wide = wide && cells[axis] >= 3;
  }
  pairs.clear();
  if (wide) {
    find_by_cells(bonds, cells, reach);
    return;
  }
  for (size_t a = 0; a < bonds.size(); a++)
    for (size_t b = a + 1; b < bonds.size(); b++)
      add_images(bonds[a], bonds[b], reach, pairs);
}

void PairList::index()
{
  first.assign((size_t)model.vertices() + 1, 0);
  for (const Pair &pair : pairs)
    first[(size_t)pair.bond + 1]++, first[(size_t)pair.other + 1]++;
  for (size_t j = 1; j < first.size(); j++)
    first[j] += first[j - 1];
  std::vector<int32_t> next(first.begin(), first.end() - 1);
  near.resize(2 * pairs.size());
  for (size_t k = 0; k < pairs.size(); k++) {
    const Pair &p = pairs[k];
    near[(size_t)next[(size_t)p.bond]++] = {p.other, {p.image[0], p.image[1], p.image[2]}, (int32_t)k};
    near[(size_t)next[(size_t)p.other]++] = {p.bond, {-p.image[0], -p.image[1], -p.image[2]}, (int32_t)k};
  }
}

void PairList::build(const std::vector<Point> &position, double wanted_skin)
{
  built = true;
  skin = wanted_skin;
  reference = position;
  std::vector<int32_t> bonds;
  for (int32_t j = 0; j < model.vertices(); j++)
    if (model.next[(size_t)j] >= 0)
      bonds.push_back(j);
  find(bonds);
  index();
}
