#include "events.h"

#include <algorithm>

#ifdef _OPENMP
#include <omp.h>
#endif

constexpr double usual_skin = 0.35;

static int thread_count()
{
#ifdef _OPENMP
  return omp_get_max_threads();
#else
  return 1;
#endif
}

static int thread_number()
{
#ifdef _OPENMP
  return omp_get_thread_num();
#else
  return 0;
#endif
}

/* --- a drift ---------------------------------------------------------------------------------------------------- */

void EventDrift::drift(double time, double start, std::vector<Point> &r, std::vector<Vector> &v,
                       std::vector<ContactRow> *rows)
{
  position = &r, velocity = &v;
  const double limit = 0.5 * (double)std::min({model.cells[0], model.cells[1], model.cells[2]});
  const double longest = take_off(time);
  if (longest >= limit)
    throw Stopped("a vertex would move by half the shortest edge or more");
  margin = 1e-4 * std::max(1.0, 4.0 * longest);
  components.clear();
  if (model.forbidden) {
    if (!list.built)
      renew_list(0.0);
    const Flights flights = {model, fibers, list,   r.data(), rate.data(),    v.data(),
                             time,  start,  margin, limit,    rows != nullptr};
    double beyond = away + longest;
    if (2.0 * beyond + margin > list.skin)
      beyond = furthest();
    if (2.0 * beyond + margin > list.skin) {
      renew_list(0.0);
      beyond = longest;
    }
    while (!fly(flights, beyond)) { // a vertex comes too far for the list: again, with a wider one
      for (const Component &component : components)
        beyond = std::max({beyond, longest, component.beyond}); // the new list begins at the start of this flight
      renew_list(beyond);
    }
    away = beyond;
    for (const Component &component : components)
      away = std::max(away, component.beyond);
    if (rows)
      tell(*rows);
  }
  land(v);
}

// Rates, and the length of the longest flight. Sizes below 2^51 are rounded by a sum: `nearest`.
double EventDrift::take_off(double time)
{
  const int64_t n = (int64_t)position->size();
  constexpr double magic = 0x1.8p52;
  rate.resize(n), way.resize(n);
  const double *const v = n > 0 ? &velocity->data()->x : nullptr;
  int64_t *const u = n > 0 ? &rate.data()->x : nullptr;
  double longest = 0.0;
#pragma omp parallel reduction(max : longest)
  {
#pragma omp for schedule(static) nowait
    for (int64_t block = 0; block < (n + 127) / 128; block++) {
      const int64_t first = 128 * block, last = std::min(first + 128, n);
      for (int64_t k = 3 * first; k < 3 * last; k++)
        u[k] = (int64_t)(bits_of(0x1p24 * (time * v[k]) + magic) - bits_of(magic));
      for (int64_t i = first; i < last; i++) {
        const double x = time * v[3 * i], y = time * v[3 * i + 1], z = time * v[3 * i + 2];
        way[i] = std::sqrt((x * x + y * y) + z * z) + 0x1p-24; // rates are rounded
      }
      for (int64_t i = first; i < last; i++)
        longest = way[i] > longest ? way[i] : longest;
      for (int64_t i = first; i < last; i++)
        longest = way[i] >= 0.0 ? longest : 0x1p60; // not a number
    }
  }
  return longest;
}

// The longest distance from its reference that a vertex comes to, if all fly straight.
double EventDrift::furthest() const
{
  const int64_t n = (int64_t)position->size();
  double most = 0.0;
#pragma omp parallel for reduction(max : most) schedule(static)
  for (int64_t i = 0; i < n; i++)
    most = std::max(most, list.moved((int32_t)i, at_tick((*position)[i], rate[i], ticks)));
  return std::sqrt(most);
}

// All pairs that may touch while no vertex is further than `need` from where it is now.
void EventDrift::renew_list(double need)
{
  list.build(*position, std::max(usual_skin, 3.0 * need + margin));
  path.assign(position->size(), 0.0);
  due = list.apart;
  away = 0.0;
  counts.lists++;
}

// False if the list is too narrow.
bool EventDrift::fly(const Flights &flights, double straight)
{
  components.clear();
  if (2.0 * straight + margin > list.skin)
    return false;
  search_list(flights);
  part_events();
  std::vector<int32_t> numbers(components.size());
  for (size_t k = 0; k < numbers.size(); k++)
    numbers[k] = (int32_t)k;
  work(flights, numbers);
  for (;;) {
    for (const Component &component : components)
      if (component.late)
        return false;
    const size_t before = components.size();
    if (before == 1 || !join_components())
      break;
    numbers.clear();
    for (size_t k = 0; k < components.size(); k++)
      if (components[k].bent.empty())
        numbers.push_back((int32_t)k);
    counts.joined += (int64_t)(before - components.size());
    work(flights, numbers);
  }
  counts.events += (int64_t)found.size(), counts.components += (int64_t)components.size();
  for (const Component &component : components) {
    counts.largest = std::max(counts.largest, (int64_t)component.answered.size());
    for (const Answered &each : component.answered)
      counts.executed += each.told, counts.softened += each.answer == SOFTENED, counts.rigid += each.rigid;
    if (component.fails)
      throw Stopped("a vertex would move by half the shortest edge or more");
  }
  return true;
}

void EventDrift::work(const Flights &flights, const std::vector<int32_t> &numbers)
{
  workers.resize((size_t)std::max(thread_count(), (int)workers.size()));
#pragma omp parallel for schedule(dynamic)
  for (size_t k = 0; k < numbers.size(); k++)
    workers[thread_number()].run(flights, components[numbers[k]]);
}

void EventDrift::land(std::vector<Vector> &v)
{
  const int64_t n = (int64_t)position->size();
#pragma omp parallel for schedule(static)
  for (int64_t i = 0; i < n; i++)
    (*position)[i] = at_tick((*position)[i], rate[i], ticks);
  if (!model.forbidden)
    return;
  path.swap(reach);
  for (const Component &component : components)
    for (const Bent &b : component.bent) {
      (*position)[b.vertex] = at_tick(b.origin, b.rate, ticks);
      v[b.vertex] = b.velocity;
      for (const int32_t bond : {b.vertex, model.prev[b.vertex]})
        if (bond >= 0 && model.next[bond] >= 0) // `reach` has the paths before this drift now
          path[bond] = std::max(path[bond], reach[bond] + b.path);
    }
}

// Rows in the order of all answers: of the components' next answers the earliest comes first.
void EventDrift::tell(std::vector<ContactRow> &rows) const
{
  struct Head {
    const Answered *at, *end;
  };
  const auto later = [](const Head &a, const Head &b) { return is_earlier(b.at->event, a.at->event); };
  std::vector<Head> heads;
  for (const Component &component : components)
    if (!component.answered.empty())
      heads.push_back({component.answered.data(), component.answered.data() + component.answered.size()});
  std::make_heap(heads.begin(), heads.end(), later);
  while (!heads.empty()) {
    std::pop_heap(heads.begin(), heads.end(), later);
    Head &head = heads.back();
    const Answered &a = *head.at;
    const Event &e = a.event;
    if (a.told)
      rows.push_back({e.bond, e.other, {e.image[0], e.image[1], e.image[2]}, e.tick, a.contact, a.momentum});
    if (++head.at == head.end)
      heads.pop_back();
    else
      std::push_heap(heads.begin(), heads.end(), later);
  }
}

/* --- contacts to come ------------------------------------------------------------------------------------------- */

namespace
{
// Pairs that are due are measured 64 at a time.
struct Search {
  const Flights &flights;
  const std::vector<double> &path, &reach;
  std::vector<double> &due;
  std::vector<Event> found;
  PairColumns columns;

  void look(int32_t number)
  {
    const Pair &p = flights.list.pairs[number];
    const int32_t i = p.bond, j = p.other, i1 = flights.model.next[i], j1 = flights.model.next[j];
    const Point edge = flights.model.edge(), shift = {p.image[0] * edge.x, p.image[1] * edge.y, p.image[2] * edge.z};
    const Point *const at = flights.origin;
    columns.add(number, in_a0(at[i1] - at[i]), in_a0(at[j1] - at[j]), in_a0((at[j] + shift) - at[i]));
    if (columns.count == pair_lanes)
      measure();
  }

  void measure()
  {
    columns.measure();
    for (int k = 0; k < columns.count; k++) {
      const int32_t number = columns.number[k];
      const Pair &p = flights.list.pairs[number];
      due[number] = path[p.bond] + path[p.other] + columns.apart[k];
      if (reach[p.bond] + reach[p.other] + flights.margin < due[number])
        continue;
      const int64_t tick = first_contact(flights.straight(p.bond, p.other, p.image), 0);
      if (tick < ticks)
        found.push_back({(int32_t)tick, p.bond, p.other, {p.image[0], p.image[1], p.image[2]}, 0});
    }
    columns.count = 0;
  }
};
} // namespace

// All pairs of the list that touch in this drift, if paths stay straight.
void EventDrift::search_list(const Flights &flights)
{
  const int64_t n = (int64_t)position->size(), pairs = (int64_t)list.pairs.size();
  reach.resize(n);
  found.clear();
#pragma omp parallel for schedule(static)
  for (int64_t i = 0; i < n; i++)
    reach[i] = path[i] + std::max(way[i], way[model.next[i] < 0 ? i : model.next[i]]);
#pragma omp parallel
  {
    Search search = {flights, path, reach, due, {}, {}};
#pragma omp for schedule(static) nowait
    for (int64_t k = 0; k < pairs; k++) {
      const Pair &p = list.pairs[k];
      if (reach[p.bond] + reach[p.other] + margin >= due[k])
        search.look((int32_t)k);
    }
    search.measure();
#pragma omp critical
    found.insert(found.end(), search.found.begin(), search.found.end());
  }
}

/* --- components ------------------------------------------------------------------------------------------------- */

namespace
{
struct Groups {
  std::vector<int32_t> parent;

  explicit Groups(size_t n) : parent(n)
  {
    for (size_t k = 0; k < n; k++)
      parent[k] = (int32_t)k;
  }
  int32_t root(int32_t k)
  {
    while (parent[k] != k)
      k = parent[k] = parent[parent[k]];
    return k;
  }
  void join(int32_t a, int32_t b)
  {
    parent[root(a)] = root(b);
  }
};

// Calls `act` with a vertex and those up to two further along its fiber: they pull at it.
template <class Act> void for_those_near(const Model &model, int32_t vertex, const Act &act)
{
  act(vertex);
  for (int32_t k = 0, j = model.next[vertex]; k < 2 && j >= 0; k++, j = model.next[j])
    act(j);
  for (int32_t k = 0, j = model.prev[vertex]; k < 2 && j >= 0; k++, j = model.prev[j])
    act(j);
}
} // namespace

// First components: events that share vertices, or have some that pull at each other. One thread works on all at once.
void EventDrift::part_events()
{
  components.clear();
  if (found.empty())
    return;
  if (thread_count() == 1) {
    components.resize(1);
    components[0].first = found;
    return;
  }
  owner.resize(position->size(), 0), place.resize(position->size(), 0);
  Groups groups(found.size());
  std::vector<int32_t> marked;
  for (size_t k = 0; k < found.size(); k++)
    for (const int32_t bond : {found[k].bond, found[k].other})
      for (const int32_t vertex : {bond, model.next[bond]})
        for_those_near(model, vertex, [&](int32_t j) {
          if (owner[j])
            groups.join((int32_t)k, owner[j] - 1);
          else
            owner[j] = (int32_t)k + 1, marked.push_back(j);
        });
  for (const int32_t j : marked)
    owner[j] = 0;
  std::vector<int32_t> number(found.size(), -1);
  for (size_t k = 0; k < found.size(); k++) {
    int32_t &its = number[groups.root((int32_t)k)];
    if (its < 0) {
      its = (int32_t)components.size();
      components.emplace_back();
    }
    components[its].first.push_back(found[k]);
  }
}

Box EventDrift::box_of(int32_t bond) const
{
  Box box;
  bool begun = false;
  for (const int32_t j : {bond, model.next[bond]}) {
    const Point from = (*position)[j];
    const Box its = owner[j] ? components[owner[j] - 1].bent[place[j]].box : Box{from, from};
    if (!begun)
      box = its, begun = true;
    box.add(its.low), box.add(its.high);
    if (!owner[j])
      box.add(at_tick(from, rate[j], ticks));
  }
  return box;
}

bool EventDrift::boxes_meet(const Box &a, int32_t other, const int32_t *image) const
{
  const Point edge = model.edge(), shift = {image[0] * edge.x, image[1] * edge.y, image[2] * edge.z};
  const Box b = box_of(other);
  const Point low = b.low + shift, high = b.high + shift;
  return a.low.x <= high.x && low.x <= a.high.x && a.low.y <= high.y && low.y <= a.high.y && a.low.z <= high.z &&
         low.z <= a.high.z;
}

// Other components that this one is not independent of.
void EventDrift::find_meetings(int32_t number, std::vector<std::pair<int32_t, int32_t>> &meetings) const
{
  for (const Bent &b : components[number].bent) {
    for_those_near(model, b.vertex, [&](int32_t j) {
      if (owner[j] && owner[j] - 1 != number)
        meetings.push_back({number, owner[j] - 1});
    });
    for (const int32_t bond : {b.vertex, model.prev[b.vertex]}) {
      if (bond < 0 || model.next[bond] < 0)
        continue;
      const Box box = box_of(bond);
      for (int32_t k = list.first[bond]; k < list.first[bond + 1]; k++) {
        const Near &near = list.near[k];
        const int32_t one = owner[near.other], its = one ? one : owner[model.next[near.other]];
        if (its > 0 && its - 1 != number && boxes_meet(box, near.other, near.image))
          meetings.push_back({number, its - 1});
      }
    }
  }
}

// Joins components that are not independent. False if all are.
bool EventDrift::join_components()
{
  std::vector<std::pair<int32_t, int32_t>> meetings;
  for (size_t c = 0; c < components.size(); c++)
    for (size_t k = 0; k < components[c].bent.size(); k++) {
      const int32_t j = components[c].bent[k].vertex;
      if (owner[j])
        meetings.push_back({(int32_t)c, owner[j] - 1});
      owner[j] = (int32_t)c + 1, place[j] = (int32_t)k;
    }
#pragma omp parallel
  {
    std::vector<std::pair<int32_t, int32_t>> some;
#pragma omp for schedule(dynamic, 16) nowait
    for (size_t c = 0; c < components.size(); c++)
      find_meetings((int32_t)c, some);
#pragma omp critical
    meetings.insert(meetings.end(), some.begin(), some.end());
  }
  for (const Component &component : components)
    for (const Bent &b : component.bent)
      owner[b.vertex] = 0;
  merge(meetings);
  return !meetings.empty();
}

// What is left of joined components are their first events.
void EventDrift::merge(const std::vector<std::pair<int32_t, int32_t>> &pairs)
{
  if (pairs.empty())
    return;
  Groups groups(components.size());
  for (const auto &pair : pairs)
    groups.join(pair.first, pair.second);
  for (size_t c = 0; c < components.size(); c++) {
    const int32_t root = groups.root((int32_t)c);
    if (root == (int32_t)c)
      continue;
    Component &to = components[root], &from = components[c];
    to.first.insert(to.first.end(), from.first.begin(), from.first.end());
    to.bent.clear();
    from.first.clear();
  }
  components.erase(
      std::remove_if(components.begin(), components.end(), [](const Component &c) { return c.first.empty(); }),
      components.end());
}
