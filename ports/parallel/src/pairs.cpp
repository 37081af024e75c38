#include "pairs.h"

#include <algorithm>

#if defined __AVX__ && !defined __CUDACC__
#include <immintrin.h>
#endif
#ifdef _OPENMP
#include <omp.h>
#endif

static bool alone()
{
#ifdef _OPENMP
  return omp_get_max_threads() == 1;
#else
  return true;
#endif
}

// The vertices of this thread.
struct Part {
  int32_t first;
  uint32_t count;
};

static Part own_part(int32_t n)
{
#ifdef _OPENMP
  const int64_t thread = omp_get_thread_num(), threads = omp_get_num_threads();
#else
  const int64_t thread = 0, threads = 1;
#endif
  const int64_t first = thread * n / threads, end = (thread + 1) * n / threads;
  return {(int32_t)first, (uint32_t)(end - first)};
}

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

// Bonds in the order of their cells, along x. What the first test reads is in columns.
struct PairList::Sorted {
  struct Bond {
    Vector first, along; // first: within the box, a0
    int32_t number, end;
    int32_t fold[3]; // what was added to `first`, in edges
  };
  int64_t cells[3];
  float width[3], longest_half;
  std::vector<int32_t> start;       // of each cell
  std::vector<float> x, y, z, half; // of the middle, within the box, a0; half of the length
  std::vector<Bond> bond;
};

// A pair of sorted bonds, and the image of the second one.
struct PairList::Waiting {
  int32_t k, l, image[3];
};

// By one thread. Pairs that may be near are measured 64 at a time.
struct PairList::Found {
  std::vector<Pair> pairs;
  std::vector<double> apart;
  PairColumns columns;
  Waiting waiting[pair_lanes];
};

PairList::PairList(const Model &model) : model(model)
{
}

PairList::~PairList() = default;

void PairList::keep_near(const Sorted &s, Found &found) const
{
  found.columns.measure();
  for (int n = 0; n < found.columns.count; n++) {
    if (!(found.columns.apart[n] < skin))
      continue;
    const Waiting &w = found.waiting[n];
    const Sorted::Bond &a = s.bond[w.k], &b = s.bond[w.l];
    const int32_t sign = a.number < b.number ? 1 : -1;
    Pair pair = {std::min(a.number, b.number), std::max(a.number, b.number), {}};
    for (int axis = 0; axis < 3; axis++)
      pair.image[axis] = sign * (b.fold[axis] + w.image[axis] - a.fold[axis]);
    found.pairs.push_back(pair);
    found.apart.push_back(found.columns.apart[n]);
  }
  found.columns.count = 0;
}

// Bond l, whose image is moved by `shift`, beside bond k.
void PairList::add(const Sorted &s, const Waiting &pair, Vector shift, Found &found) const
{
  const Sorted::Bond &a = s.bond[pair.k], &b = s.bond[pair.l];
  found.waiting[found.columns.count] = pair;
  found.columns.add(0, a.along, b.along, (b.first - a.first) + shift);
  if (found.columns.count == pair_lanes)
    keep_near(s, found);
}

/* --- small boxes: all images ------------------------------------------------------------------------------------ */

void PairList::find_images(const Sorted &s, int32_t k, int32_t l, double reach, Found &found) const
{
  const int32_t bond = bonds[k], other = bonds[l], end = model.next[bond], other_end = model.next[other];
  if (bond == other_end || end == other || end == other_end)
    return;
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
        add(s, {k, l, {(int32_t)x, (int32_t)y, (int32_t)z}}, in_a0(Point{x * edge.x, y * edge.y, z * edge.z}), found);
}

/* --- large ones: cells ------------------------------------------------------------------------------------------ */

constexpr int at_once = 8;

// Bit k is set if the middle k of these, with half its length and `reach`, is near a place.
static uint32_t those_near(const float *x, const float *y, const float *z, const float *half, const float *at, float reach)
{
  uint32_t near = 0;
#if defined __AVX__ && !defined __CUDACC__
  const auto apart = [](const float *from, float place) { return _mm256_sub_ps(_mm256_loadu_ps(from), _mm256_set1_ps(place)); };
  const __m256 dx = apart(x, at[0]), dy = apart(y, at[1]), dz = apart(z, at[2]), far = apart(half, -reach);
  const __m256 squares = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
  near = (uint32_t)_mm256_movemask_ps(_mm256_sub_ps(squares, _mm256_mul_ps(far, far)));
#else
  for (int k = 0; k < at_once; k++) {
    const float dx = x[k] - at[0], dy = y[k] - at[1], dz = z[k] - at[2], far = half[k] + reach;
    near |= (uint32_t)(dx * dx + dy * dy + dz * dz < far * far) << k;
  }
#endif
  return near;
}

// Wrong by this at most, in boxes of up to 1000 a0: places in single precision.
constexpr float middle_error = 2e-3f;
constexpr int64_t parts_of_x = 2; // a cell is as wide as the reach along y and z, and a part of it along x

void PairList::sort_bonds(Sorted &s) const
{
  const size_t n = bonds.size();
  const Point edge = model.edge();
  const Vector inverse = {1.0 / (double)edge.x, 1.0 / (double)edge.y, 1.0 / (double)edge.z};
  const auto cell_along = [](int64_t folded, double inverse, int64_t n) {
    return std::min((int64_t)((double)folded * inverse * (double)n), n - 1);
  };
  const auto fold_of = [](int64_t x, int64_t edge, double inverse) {
    const int64_t k = (int64_t)((double)x * inverse), left = x - k * edge;
    return left >= 0 && left < edge ? -k : -floor_divide(x, edge);
  };
  std::vector<Point> fold(n);
  std::vector<int32_t> number(n);
#pragma omp parallel for schedule(static)
  for (size_t k = 0; k < n; k++) {
    const Point r = middle[bonds[k]];
    const Point f = {fold_of(r.x, edge.x, inverse.x), fold_of(r.y, edge.y, inverse.y), fold_of(r.z, edge.z, inverse.z)};
    const int64_t x = cell_along(r.x + f.x * edge.x, inverse.x, s.cells[0]),
                  y = cell_along(r.y + f.y * edge.y, inverse.y, s.cells[1]),
                  z = cell_along(r.z + f.z * edge.z, inverse.z, s.cells[2]);
    fold[k] = f;
    number[k] = (int32_t)((z * s.cells[1] + y) * s.cells[0] + x);
  }
  s.start.assign(s.cells[0] * s.cells[1] * s.cells[2] + 1, 0);
  for (size_t k = 0; k < n; k++)
    s.start[number[k] + 1]++;
  for (size_t c = 1; c < s.start.size(); c++)
    s.start[c] += s.start[c - 1];
  std::vector<int32_t> next(s.start.begin(), s.start.end() - 1);
  for (size_t k = 0; k < n; k++)
    number[k] = next[number[k]]++;
  s.bond.resize(n);
  s.x.resize(n + at_once), s.y.resize(n + at_once), s.z.resize(n + at_once), s.half.resize(n + at_once);
#pragma omp parallel for schedule(static)
  for (size_t k = 0; k < n; k++) {
    const int32_t to = number[k], i = bonds[k];
    const Point f = fold[k], added = {f.x * edge.x, f.y * edge.y, f.z * edge.z};
    const Vector along = in_a0(reference[model.next[i]] - reference[i]), at = in_a0(middle[i] + added);
    s.bond[to] = {in_a0(reference[i] + added), along, i, model.next[i], {(int32_t)f.x, (int32_t)f.y, (int32_t)f.z}};
    s.x[to] = (float)at.x, s.y[to] = (float)at.y, s.z[to] = (float)at.z;
    s.half[to] = (float)(0.5 * std::sqrt(dot(along, along)));
  }
}

// A row of partners of a cell's bonds, in the order of the cells, and which image of it.
struct PairList::Run {
  int32_t from, to;
  int y, z; // from the cell
  Point image;
};

// Rows of partners after this cell, in the order of the cells: of two neighbors one has the other.
int PairList::runs_around(const Sorted &s, int64_t x, int64_t y, int64_t z, Run *runs) const
{
  static constexpr int row_y[5] = {0, 1, -1, 0, 1}, row_z[5] = {0, 0, 1, 1, 1};
  const int64_t nx = s.cells[0], last = x + parts_of_x, begin = x - parts_of_x;
  int count = 0;
  for (int n = 0; n < 5; n++) {
    const int64_t its_y = y + row_y[n], its_z = z + row_z[n];
    const int64_t over_y = its_y < 0 ? -1 : its_y == s.cells[1], over_z = its_z == s.cells[2];
    const int32_t *const start =
        s.start.data() + ((its_z - over_z * s.cells[2]) * s.cells[1] + (its_y - over_y * s.cells[1])) * nx;
    const auto add_run = [&](int64_t from, int64_t to, int64_t over_x) {
      if (start[from] < start[to])
        runs[count++] = {start[from], start[to], row_y[n], row_z[n], {over_x, over_y, over_z}};
    };
    const int64_t from = n == 0 ? x : begin;
    add_run(std::max(from, (int64_t)0), std::min(last + 1, nx), 0);
    if (from < 0)
      add_run(nx + from, nx, -1);
    if (last >= nx)
      add_run(0, last + 1 - nx, 1);
  }
  return count;
}

void PairList::find_around(const Sorted &s, int64_t cell, Found &found) const
{
  const int32_t begin = s.start[cell], end = s.start[cell + 1];
  if (begin == end)
    return;
  const int64_t nx = s.cells[0], x = cell % nx, y = cell / nx % s.cells[1], z = cell / nx / s.cells[1];
  Run runs[15];
  const int count = runs_around(s, x, y, z, runs);
  const Vector edge = in_a0(model.edge());
  for (int32_t k = begin; k < end; k++) {
    const float reach = s.half[k] + (float)skin + middle_error, most = reach + s.longest_half;
    const float above = (float)(y + 1) * s.width[1] - s.y[k], below = s.y[k] - (float)y * s.width[1],
                behind = (float)(z + 1) * s.width[2] - s.z[k];
    for (int n = 0; n < count; n++) {
      const Run &run = runs[n];
      const float dy = std::max((run.y > 0 ? above : run.y < 0 ? below : 0.0f) - middle_error, 0.0f),
                  dz = std::max((run.z > 0 ? behind : 0.0f) - middle_error, 0.0f);
      if (dy * dy + dz * dz < most * most)
        look(s, k, run, {run.image.x * edge.x, run.image.y * edge.y, run.image.z * edge.z}, reach, found);
    }
  }
}

// Those of a row that are near bond k and come after it.
void PairList::look(const Sorted &s, int32_t k, const Run &run, Vector shift, float reach, Found &found) const
{
  const float at[3] = {s.x[k] - (float)shift.x, s.y[k] - (float)shift.y, s.z[k] - (float)shift.z};
  const float *const x = s.x.data(), *const y = s.y.data(), *const z = s.z.data(), *const half = s.half.data();
  const int32_t bond = s.bond[k].number, end = s.bond[k].end;
  const bool own = run.y == 0 && run.z == 0 && run.image.x == 0;
  for (int32_t m = own ? std::max(run.from, k + 1) : run.from; m < run.to; m += at_once) {
    uint32_t near = those_near(x + m, y + m, z + m, half + m, at, reach);
    if (run.to - m < at_once)
      near &= (1u << (run.to - m)) - 1;
    for (; near; near &= near - 1) {
      const int32_t l = m + __builtin_ctz(near);
      if (bond != s.bond[l].end && end != s.bond[l].number && end != s.bond[l].end)
        add(s, {k, l, {(int32_t)run.image.x, (int32_t)run.image.y, (int32_t)run.image.z}}, shift, found);
    }
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
    s.cells[0] *= parts_of_x;
    for (int axis = 0; axis < 3; axis++)
      s.width[axis] = (float)model.cells[axis] / (float)s.cells[axis];
    s.longest_half = (float)(0.5 * std::sqrt(longest)) + middle_error;
    sort_bonds(s);
  } else {
    for (const int32_t i : bonds)
      s.bond.push_back({in_a0(reference[i]), in_a0(reference[model.next[i]] - reference[i]), i, model.next[i], {}});
  }
  const int64_t work = wide ? (int64_t)s.start.size() - 1 : (int64_t)bonds.size(), parts = wide && !alone() ? 64 : 1;
  found.resize((size_t)parts); // in one order, whoever finds them
#pragma omp parallel for schedule(dynamic)
  for (int64_t part = 0; part < parts; part++) {
    Found &mine = found[(size_t)part];
    mine.pairs.clear(), mine.apart.clear();
    for (int64_t k = part * work / parts; k < (part + 1) * work / parts; k++)
      if (wide)
        find_around(s, k, mine);
      else
        for (size_t m = (size_t)k + 1; m < bonds.size(); m++)
          find_images(s, (int32_t)k, (int32_t)m, reach, mine);
    keep_near(s, mine);
  }
  gather();
}

// All parts, in their order.
void PairList::gather()
{
  if (found.size() == 1) {
    pairs.swap(found[0].pairs), apart.swap(found[0].apart);
    return;
  }
  std::vector<size_t> begin(found.size() + 1, 0);
  for (size_t part = 0; part < found.size(); part++)
    begin[part + 1] = begin[part] + found[part].pairs.size();
  pairs.resize(begin.back()), apart.resize(begin.back());
#pragma omp parallel for schedule(static)
  for (size_t part = 0; part < found.size(); part++) {
    std::copy(found[part].pairs.begin(), found[part].pairs.end(), pairs.begin() + (int64_t)begin[part]);
    std::copy(found[part].apart.begin(), found[part].apart.end(), apart.begin() + (int64_t)begin[part]);
  }
}

// Each thread reads all pairs and writes the entries of its own bonds.
void PairList::index()
{
  const int32_t n = model.vertices();
  first.assign((size_t)n + 1, 0);
  near.resize(2 * pairs.size());
  index_next.resize((size_t)n);
#pragma omp parallel
  {
    const Part part = own_part(n);
    const auto mine = [part](int32_t bond) { return (uint32_t)(bond - part.first) < part.count; };
    for (const Pair &pair : pairs) {
      if (mine(pair.bond))
        first[pair.bond + 1]++;
      if (mine(pair.other))
        first[pair.other + 1]++;
    }
#pragma omp barrier
#pragma omp single
    for (int32_t j = 0; j < n; j++) {
      first[j + 1] += first[j];
      index_next[j] = first[j];
    }
    for (size_t k = 0; k < pairs.size(); k++) {
      const Pair &p = pairs[k];
      if (mine(p.bond))
        near[index_next[p.bond]++] = {p.other, {p.image[0], p.image[1], p.image[2]}, (int32_t)k};
      if (mine(p.other))
        near[index_next[p.other]++] = {p.bond, {-p.image[0], -p.image[1], -p.image[2]}, (int32_t)k};
    }
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
