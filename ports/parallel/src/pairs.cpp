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
  const Point between = middle[(size_t)other] - middle[(size_t)bond], edge = model.edge();
  const int64_t far = (int64_t)(reach * lattice_per_a0);
  const int64_t apart[3] = {between.x, between.y, between.z}, edges[3] = {edge.x, edge.y, edge.z};
  int64_t low[3], high[3];
  for (int axis = 0; axis < 3; axis++) { // |apart + k edge| <= far
    low[axis] = -floor_divide(apart[axis] + far, edges[axis]);
    high[axis] = floor_divide(far - apart[axis], edges[axis]);
    if (low[axis] > high[axis])
      return;
  }
  for (int64_t x = low[0]; x <= high[0]; x++)
    for (int64_t y = low[1]; y <= high[1]; y++)
      for (int64_t z = low[2]; z <= high[2]; z++) {
        const Point shift = {x * edge.x, y * edge.y, z * edge.z};
        const Vector at = in_a0(between + shift);
        if (dot(at, at) <= reach * reach)
          add_pair(bond, other, {x, y, z}, found);
      }
}

// Bonds in the order of their cells: middles within the box, a0, and what was added to them, in edges.
struct Sorted {
  std::vector<int32_t> bond, start; // start: of each cell
  std::vector<Vector> middle;
  std::vector<double> half; // of the length
  std::vector<Point> folds, cell;
};

static Sorted sort_bonds(const Model &model, const std::vector<int32_t> &bonds, const std::vector<Point> &reference,
                         const std::vector<Point> &middle, const int64_t cells[3])
{
  const size_t n = bonds.size();
  const Point edge = model.edge();
  const auto cell_along = [](int64_t folded, int64_t edge, int64_t n) {
    return std::min((int64_t)((double)folded / (double)edge * (double)n), n - 1);
  };
  Sorted s;
  std::vector<Point> fold(n), cell(n);
  std::vector<size_t> number(n);
  s.start.assign((size_t)(cells[0] * cells[1] * cells[2] + 1), 0);
  for (size_t k = 0; k < n; k++) {
    const Point r = middle[(size_t)bonds[k]];
    fold[k] = {-floor_divide(r.x, edge.x), -floor_divide(r.y, edge.y), -floor_divide(r.z, edge.z)};
    cell[k] = {cell_along(r.x + fold[k].x * edge.x, edge.x, cells[0]),
               cell_along(r.y + fold[k].y * edge.y, edge.y, cells[1]),
               cell_along(r.z + fold[k].z * edge.z, edge.z, cells[2])};
    number[k] = (size_t)((cell[k].z * cells[1] + cell[k].y) * cells[0] + cell[k].x);
    s.start[number[k] + 1]++;
  }
  for (size_t c = 1; c < s.start.size(); c++)
    s.start[c] += s.start[c - 1];
  std::vector<int32_t> next(s.start.begin(), s.start.end() - 1);
  s.bond.resize(n), s.middle.resize(n), s.half.resize(n), s.folds.resize(n), s.cell.resize(n);
  for (size_t k = 0; k < n; k++) {
    const size_t to = (size_t)next[number[k]]++, i = (size_t)bonds[k];
    const Vector along = in_a0(reference[(size_t)model.next[i]] - reference[i]);
    s.bond[to] = bonds[k], s.folds[to] = fold[k], s.cell[to] = cell[k];
    s.middle[to] = in_a0(middle[i] + Point{fold[k].x * edge.x, fold[k].y * edge.y, fold[k].z * edge.z});
    s.half[to] = 0.5 * std::sqrt(dot(along, along)) + 1e-6;
  }
  return s;
}

// Adds a pair if its image is closer than the skin.
void PairList::add_pair(int32_t bond, int32_t other, Point image, std::vector<Pair> &found) const
{
  const size_t i = (size_t)bond, j = (size_t)other, i1 = (size_t)model.next[i], j1 = (size_t)model.next[j];
  if (i == j1 || i1 == j || i1 == j1)
    return;
  const Point edge = model.edge(), shift = {image.x * edge.x, image.y * edge.y, image.z * edge.z};
  const Vector p = in_a0(reference[i1] - reference[i]), q = in_a0(reference[j1] - reference[j]);
  const Vector w = in_a0(reference[j] + shift - reference[i]), n = cross(p, q);
  const double between_lines = dot(w, n);
  if (between_lines * between_lines > (1.000001 * skin * skin) * dot(n, n) || bond_distance(p, q, w) >= skin)
    return;
  if (bond < other)
    found.push_back({bond, other, {(int32_t)image.x, (int32_t)image.y, (int32_t)image.z}});
  else
    found.push_back({other, bond, {(int32_t)-image.x, (int32_t)-image.y, (int32_t)-image.z}});
}

// Partners of one bond, among those that come after it in the order of the cells.
void PairList::find_around(const Sorted &s, size_t k, const int64_t cells[3], std::vector<Pair> &found) const
{
  const Vector edge = in_a0(model.edge());
  for (int n = 0; n < 27; n++) {
    int64_t at[3] = {s.cell[k].x + n % 3 - 1, s.cell[k].y + n / 3 % 3 - 1, s.cell[k].z + n / 9 - 1}, image[3];
    for (int axis = 0; axis < 3; axis++) {
      image[axis] = at[axis] < 0 ? -1 : at[axis] == cells[axis];
      at[axis] -= image[axis] * cells[axis];
    }
    const size_t cell = (size_t)((at[2] * cells[1] + at[1]) * cells[0] + at[0]);
    const Vector from =
        s.middle[k] - Vector{(double)image[0] * edge.x, (double)image[1] * edge.y, (double)image[2] * edge.z};
    const double reach = s.half[k] + skin;
    for (size_t m = std::max((size_t)s.start[cell], k + 1); m < (size_t)s.start[cell + 1]; m++) {
      const Vector d = s.middle[m] - from;
      const double far = reach + s.half[m];
      if (dot(d, d) < far * far)
        add_pair(s.bond[k], s.bond[m], s.folds[m] + Point{image[0], image[1], image[2]} - s.folds[k], found);
    }
  }
}

// Cells at least as wide as the reach of a bond's middle: partners are in the 27 cells around.
void PairList::find_by_cells(const std::vector<int32_t> &bonds, const int64_t cells[3])
{
  const Sorted s = sort_bonds(model, bonds, reference, middle, cells);
  std::vector<std::vector<Pair>> parts(64); // in one order, whoever finds them
#pragma omp parallel for schedule(dynamic)
  for (size_t part = 0; part < parts.size(); part++)
    for (size_t k = part * bonds.size() / parts.size(); k < (part + 1) * bonds.size() / parts.size(); k++)
      find_around(s, k, cells, parts[part]);
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
    find_by_cells(bonds, cells);
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
