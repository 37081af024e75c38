#include "pairs.h"

#include <algorithm>

// The best s of the two lines, cut to the bond; the best t for it, cut; the best s for this t. Where bonds are nearly
// parallel s and t are inexact, and the distance hardly depends on them.
void PairColumns::measure()
{
  constexpr double none = 0x1p-1000; // bonds without length, or parallel, divide 0 by this
  const auto cut = [](double s) { return s < 0.0 ? 0.0 : s > 1.0 ? 1.0 : s; };
  for (int k = 0; k < count; k++) {
    const Vector a = {p[0][k], p[1][k], p[2][k]}, b = {q[0][k], q[1][k], q[2][k]}, c = {w[0][k], w[1][k], w[2][k]};
    const Vector n = cross(a, b);
    const double aa = dot(a, a) + none, bb = dot(b, b) + none, nn = dot(n, n) + none;
    const double ab = dot(a, b), ac = dot(a, c), bc = dot(b, c);
    const double t = cut((cut((ac * bb - ab * bc) / nn) * ab - bc) / bb), s = cut((t * ab + ac) / aa);
    const Vector gap = (c + t * b) - s * a;
    apart[k] = std::sqrt(dot(gap, gap));
  }
}

static int64_t floor_divide(int64_t a, int64_t b)
{
  return a / b - (a % b < 0);
}

// Pairs that may be near are measured 64 at a time.
struct PairList::Found {
  std::vector<Pair> pairs;
  std::vector<double> apart;
  PairColumns columns;
  Pair waiting[pair_lanes];
};

void PairList::keep_near(Found &found) const
{
  found.columns.measure();
  for (int k = 0; k < found.columns.count; k++)
    if (found.columns.apart[k] < skin) {
      found.pairs.push_back(found.waiting[k]);
      found.apart.push_back(found.columns.apart[k]);
    }
  found.columns.count = 0;
}

void PairList::add(int32_t bond, int32_t other, Point image, Found &found) const
{
  if (bond > other) {
    std::swap(bond, other);
    image = {-image.x, -image.y, -image.z};
  }
  const int32_t end = model.next[bond], other_end = model.next[other];
  if (bond == other_end || end == other || end == other_end)
    return;
  const Point edge = model.edge(), shift = {image.x * edge.x, image.y * edge.y, image.z * edge.z};
  found.waiting[found.columns.count] = {bond, other, {(int32_t)image.x, (int32_t)image.y, (int32_t)image.z}};
  found.columns.add(0, in_a0(reference[end] - reference[bond]), in_a0(reference[other_end] - reference[other]),
                    in_a0(reference[other] + shift - reference[bond]));
  if (found.columns.count == pair_lanes)
    keep_near(found);
}

/* --- small boxes: all images ------------------------------------------------------------------------------------ */

void PairList::find_images(int32_t bond, int32_t other, double reach, Found &found) const
{
  const Point between = middle[other] - middle[bond], edge = model.edge();
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
      for (int64_t z = low[2]; z <= high[2]; z++)
        add(bond, other, {x, y, z}, found);
}

/* --- large ones: cells ------------------------------------------------------------------------------------------ */

// Bonds in the order of their cells: middles within the box, a0, and what was added to them, in edges.
struct PairList::Sorted {
  int64_t cells[3];
  float width[3], longest_half;
  std::vector<int32_t> bond, start; // start: of each cell
  std::vector<float> x, y, z, half; // half: of the length
  std::vector<Point> folds, cell;
};

constexpr int at_once = 8;

// Wrong by this at most, in boxes of up to 1000 a0: places in single precision.
constexpr float middle_error = 2e-3f;

void PairList::sort_bonds(Sorted &s) const
{
  const size_t n = bonds.size();
  const Point edge = model.edge();
  const auto cell_along = [](int64_t folded, int64_t edge, int64_t n) {
    return std::min((int64_t)((double)folded / (double)edge * (double)n), n - 1);
  };
  std::vector<Point> fold(n), cell(n);
  std::vector<int32_t> number(n);
#pragma omp parallel for schedule(static)
  for (size_t k = 0; k < n; k++) {
    const Point r = middle[bonds[k]];
    fold[k] = {-floor_divide(r.x, edge.x), -floor_divide(r.y, edge.y), -floor_divide(r.z, edge.z)};
    cell[k] = {cell_along(r.x + fold[k].x * edge.x, edge.x, s.cells[0]),
               cell_along(r.y + fold[k].y * edge.y, edge.y, s.cells[1]),
               cell_along(r.z + fold[k].z * edge.z, edge.z, s.cells[2])};
    number[k] = (int32_t)((cell[k].z * s.cells[1] + cell[k].y) * s.cells[0] + cell[k].x);
  }
  s.start.assign(s.cells[0] * s.cells[1] * s.cells[2] + 1, 0);
  for (size_t k = 0; k < n; k++)
    s.start[number[k] + 1]++;
  for (size_t c = 1; c < s.start.size(); c++)
    s.start[c] += s.start[c - 1];
  std::vector<int32_t> next(s.start.begin(), s.start.end() - 1);
  for (size_t k = 0; k < n; k++)
    number[k] = next[number[k]]++;
  s.bond.resize(n), s.folds.resize(n), s.cell.resize(n);
  s.x.resize(n + at_once), s.y.resize(n + at_once), s.z.resize(n + at_once), s.half.resize(n + at_once);
#pragma omp parallel for schedule(static)
  for (size_t k = 0; k < n; k++) {
    const int32_t to = number[k], i = bonds[k];
    const Vector along = in_a0(reference[model.next[i]] - reference[i]);
    const Vector at = in_a0(middle[i] + Point{fold[k].x * edge.x, fold[k].y * edge.y, fold[k].z * edge.z});
    s.bond[to] = i, s.folds[to] = fold[k], s.cell[to] = cell[k];
    s.x[to] = (float)at.x, s.y[to] = (float)at.y, s.z[to] = (float)at.z;
    s.half[to] = (float)(0.5 * std::sqrt(dot(along, along)));
  }
}

// Distance along an axis of a place from a cell.
static float gap(float at, int64_t cell, float width)
{
  return std::max({(float)cell * width - at, at - (float)(cell + 1) * width, 0.0f});
}

// Partners of one bond, among those that come after it in the order of the cells. Cells of a row are next to each
// other.
void PairList::find_around(const Sorted &s, size_t k, Found &found) const
{
  const Vector edge = in_a0(model.edge());
  const float reach = s.half[k] + (float)skin + middle_error;
  const auto look = [&](int64_t from, int64_t to, Point image) {
    const float *const sx = s.x.data(), *const sy = s.y.data(), *const sz = s.z.data(), *const half = s.half.data();
    const float x = s.x[k] - (float)(image.x * edge.x), y = s.y[k] - (float)(image.y * edge.y),
                z = s.z[k] - (float)(image.z * edge.z);
    for (int64_t m = std::max(from, (int64_t)k + 1); m < to; m += at_once) {
      const int n = (int)std::min((int64_t)at_once, to - m);
      int32_t close[at_once], any = 0;
      for (int l = 0; l < at_once; l++) { // those beyond n are not looked at
        const float dx = sx[m + l] - x, dy = sy[m + l] - y, dz = sz[m + l] - z, far = reach + half[m + l];
        close[l] = dx * dx + dy * dy + dz * dz < far * far ? 1 : 0;
        any |= close[l];
      }
      for (int l = 0; any && l < n; l++)
        if (close[l])
          add(s.bond[k], s.bond[m + l], s.folds[m + l] + image - s.folds[k], found);
    }
  };
  const int64_t nx = s.cells[0];
  const float most = reach + s.longest_half;
  for (int n = 0; n < 9; n++) {
    const int64_t y = s.cell[k].y + n % 3 - 1, z = s.cell[k].z + n / 3 - 1;
    const float dy = gap(s.y[k], y, s.width[1]), dz = gap(s.z[k], z, s.width[2]),
                left = most * most - dy * dy - dz * dz;
    if (left < 0.0f)
      continue;
    const int64_t over_y = y < 0 ? -1 : y == s.cells[1], over_z = z < 0 ? -1 : z == s.cells[2];
    const int64_t row = ((z - over_z * s.cells[2]) * s.cells[1] + (y - over_y * s.cells[1])) * nx;
    const float far = std::sqrt(left) + middle_error;
    const int64_t from = (int64_t)std::floor((s.x[k] - far) / s.width[0]);
    const int64_t to = (int64_t)std::floor((s.x[k] + far) / s.width[0]) + 1;
    look(s.start[row + std::max(from, (int64_t)0)], s.start[row + std::min(to, nx)], {0, over_y, over_z});
    if (from < 0)
      look(s.start[row + nx + from], s.start[row + nx], {-1, over_y, over_z});
    if (to > nx)
      look(s.start[row], s.start[row + to - nx], {1, over_y, over_z});
  }
}

void PairList::find()
{
  double longest = 0.0;
  middle.resize(reference.size());
#pragma omp parallel for reduction(max : longest) schedule(static)
  for (size_t k = 0; k < bonds.size(); k++) {
    const Point a = reference[bonds[k]], r = reference[model.next[bonds[k]]] - a;
    longest = std::max(longest, dot(in_a0(r), in_a0(r)));
    middle[bonds[k]] = a + Point{r.x / 2, r.y / 2, r.z / 2};
  }
  const double reach = std::sqrt(longest) + skin + 1e-6; // of middles
  Sorted s;
  bool wide = true;
  for (int axis = 0; axis < 3; axis++) { // at least as wide as the reach: partners are in the 27 cells around
    s.cells[axis] = (int64_t)((double)model.cells[axis] / (reach + 2 * middle_error));
    wide = wide && s.cells[axis] >= 3 && model.cells[axis] <= 1000;
  }
  if (wide) {
    s.cells[0] *= 4; // a row is cut where the bond's reach ends
    for (int axis = 0; axis < 3; axis++)
      s.width[axis] = (float)model.cells[axis] / (float)s.cells[axis];
    s.longest_half = (float)(0.5 * std::sqrt(longest)) + middle_error;
    sort_bonds(s);
  }
  const size_t parts = wide ? 64 : 1;
  std::vector<Found> found(parts); // in one order, whoever finds them
#pragma omp parallel for schedule(dynamic)
  for (size_t part = 0; part < parts; part++) {
    for (size_t k = part * bonds.size() / parts; k < (part + 1) * bonds.size() / parts; k++)
      if (wide)
        find_around(s, k, found[part]);
      else
        for (size_t m = k + 1; m < bonds.size(); m++)
          find_images(bonds[k], bonds[m], reach, found[part]);
    keep_near(found[part]);
  }
  pairs.clear(), apart.clear();
  for (const Found &part : found) {
    pairs.insert(pairs.end(), part.pairs.begin(), part.pairs.end());
    apart.insert(apart.end(), part.apart.begin(), part.apart.end());
  }
}

void PairList::index()
{
  first.assign(model.vertices() + 1, 0);
  for (const Pair &pair : pairs)
    first[pair.bond + 1]++, first[pair.other + 1]++;
  for (size_t j = 1; j < first.size(); j++)
    first[j] += first[j - 1];
  std::vector<int32_t> next(first.begin(), first.end() - 1);
  near.resize(2 * pairs.size());
  for (size_t k = 0; k < pairs.size(); k++) {
    const Pair &p = pairs[k];
    near[next[p.bond]++] = {p.other, {p.image[0], p.image[1], p.image[2]}, (int32_t)k};
    near[next[p.other]++] = {p.bond, {-p.image[0], -p.image[1], -p.image[2]}, (int32_t)k};
  }
}

void PairList::build(const std::vector<Point> &position, double wanted_skin)
{
  built = true;
  skin = wanted_skin;
  reference = position;
  if (bonds.empty())
    for (int32_t j = 0; j < model.vertices(); j++)
      if (model.next[j] >= 0)
        bonds.push_back(j);
  find();
  index();
}
