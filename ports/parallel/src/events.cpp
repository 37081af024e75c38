#include "events.h"

#include <algorithm>

constexpr int most_contacts = 1000;
constexpr double usual_skin = 0.3;

bool EventDrift::Later::operator()(const Event &a, const Event &b) const
{
  if (a.tick != b.tick)
    return a.tick > b.tick;
  if (a.bond != b.bond)
    return a.bond > b.bond;
  if (a.other != b.other)
    return a.other > b.other;
  return std::lexicographical_compare(b.image, b.image + 3, a.image, a.image + 3);
}

static Point rate_of(double time, Vector velocity)
{
  return nearest(0x1p24 * (time * velocity));
}

static double length_of(Point a)
{
  const Vector r = in_a0(a);
  return std::sqrt(dot(r, r));
}

/* --- a drift -------------------------------------------------------------------------------------------------------
 */

void EventDrift::drift(double drift_time, double drift_start, std::vector<Point> &r, std::vector<Vector> &v,
                       std::vector<ContactRow> *told)
{
  position = &r, velocity = &v;
  take_off(drift_time);
  if (!model.forbidden) {
    land();
    return;
  }
  const std::vector<Vector> before = v;
  const size_t rows_before = told ? told->size() : 0;
  while (!fly(drift_time, drift_start, told)) { // a vertex came too far for the list: again, with a wider one
    v = before;
    if (told)
      told->resize(rows_before);
    take_off(drift_time);
    renew_list(beyond);
  }
  land();
}

// Rates, and places of tick 0.
void EventDrift::take_off(double drift_time)
{
  const size_t n = position->size();
  time = drift_time;
  origin = *position;
  rate.resize(n);
  bent_number.assign(n, 0);
  bent.clear();
  clusters = 0;
  events = {};
  version.resize(n);
  const double limit = 0.5 * (double)std::min({model.cells[0], model.cells[1], model.cells[2]});
  double longest = 0.0;
#pragma omp parallel for reduction(max : longest) schedule(static)
  for (size_t i = 0; i < n; i++) {
    rate[i] = rate_of(time, (*velocity)[i]);
    longest = std::max(longest, length_of(ticks * rate[i]));
  }
  if (longest >= limit)
    throw Stopped("a vertex would move by half the shortest edge or more");
  margin = 1e-4 * std::max(1.0, 4.0 * longest);
}

// All pairs that may touch while no vertex is further than `need` from where it is now.
void EventDrift::renew_list(double need)
{
  list.build(*position, std::max(usual_skin, 3.0 * need + margin));
  const size_t n = position->size();
  path.assign(n, 0.0);
  pair_due.assign(list.pairs.size(), 0.0);
}

bool EventDrift::fly(double, double drift_start, std::vector<ContactRow> *told)
{
  const size_t n = position->size();
  start = drift_start, rows = told;
  if (!list.built)
    renew_list(0.0);
  for (int attempt = 0; attempt < 2; attempt++) {
    double furthest = 0.0;
#pragma omp parallel for reduction(max : furthest) schedule(static)
    for (size_t i = 0; i < n; i++)
      furthest = std::max(furthest, list.moved((int32_t)i, at_tick(origin[i], rate[i], ticks)));
    beyond = std::sqrt(furthest);
    if (2.0 * beyond + margin <= list.skin)
      break;
    renew_list(attempt == 0 ? 0.0 : beyond);
  }
  if (2.0 * beyond + margin > list.skin)
    return false;
  search_list();
  while (!events.empty()) {
    const Event event = events.top();
    events.pop();
    if (event.version == version[(size_t)event.bond] + version[(size_t)event.other])
      answer(event);
    if (2.0 * beyond + margin > list.skin)
      return false;
  }
  return true;
}

void EventDrift::land()
{
  const size_t n = position->size();
#pragma omp parallel for schedule(static)
  for (size_t i = 0; i < n; i++)
    (*position)[i] = at_tick(origin[i], rate[i], ticks);
  if (!model.forbidden)
    return;
  for (Bent &b : bent) {
    b.path += length_of((ticks - b.since) * rate[(size_t)b.vertex]);
    for (const int32_t bond : {b.vertex, model.prev[(size_t)b.vertex]})
      if (bond >= 0 && model.next[(size_t)bond] >= 0)
        flown[(size_t)bond] = std::max(flown[(size_t)bond], b.path);
  }
#pragma omp parallel for schedule(static)
  for (size_t i = 0; i < n; i++)
    path[i] += flown[i];
}

/* --- contacts to come ----------------------------------------------------------------------------------------------
 */

Flight3 EventDrift::flight_of(int32_t bond, int32_t other, const int32_t *image) const
{
  const size_t i = (size_t)bond, i1 = (size_t)model.next[i], j = (size_t)other, j1 = (size_t)model.next[j];
  const Point edge = model.edge(), shift = {image[0] * edge.x, image[1] * edge.y, image[2] * edge.z};
  return {origin[i1] - origin[i], origin[j1] - origin[j], (origin[j] + shift) - origin[i],
          rate[i1] - rate[i],     rate[j1] - rate[j],     rate[j] - rate[i]};
}

void EventDrift::search_pair(int32_t number, int64_t from, std::vector<Event> &found) const
{
  const Pair &p = list.pairs[(size_t)number];
  const int64_t tick = first_contact(flight_of(p.bond, p.other, p.image), from);
  if (tick < ticks)
    found.push_back({(int32_t)tick,
                     p.bond,
                     p.other,
                     {p.image[0], p.image[1], p.image[2]},
                     version[(size_t)p.bond] + version[(size_t)p.other]});
}

// All pairs of the list that may touch in this drift, if paths stay straight.
void EventDrift::search_list()
{
  const size_t n = position->size();
  flown.assign(n, 0.0);
#pragma omp parallel for schedule(static)
  for (size_t i = 0; i < n; i++)
    if (model.next[i] >= 0)
      flown[i] = std::max(length_of(ticks * rate[i]), length_of(ticks * rate[(size_t)model.next[i]]));
#pragma omp parallel
  {
    std::vector<Event> found;
#pragma omp for schedule(static) nowait
    for (size_t k = 0; k < list.pairs.size(); k++) {
      const Pair &p = list.pairs[k];
      const size_t i = (size_t)p.bond, j = (size_t)p.other;
      const double here = path[i] + path[j], way = flown[i] + flown[j] + margin;
      if (here + way < pair_due[k])
        continue;
      const Flight3 f = flight_of(p.bond, p.other, p.image);
      const double apart = bond_distance(in_a0(f.p), in_a0(f.q), in_a0(f.w));
      pair_due[k] = here + apart;
      if (way >= apart)
        search_pair((int32_t)k, 0, found);
    }
#pragma omp critical
    for (const Event &event : found)
      events.push(event);
  }
}

/* --- answers ---------------------------------------------------------------------------------------------------------
 */

EventDrift::Bent &EventDrift::bent_of(int32_t vertex)
{
  int32_t &number = bent_number[(size_t)vertex];
  if (!number) {
    bent.push_back({vertex, 0, 0, 0.0, 0});
    number = (int32_t)bent.size();
  }
  return bent[(size_t)number - 1];
}

// A new rate, with the place at this tick kept.
void EventDrift::bend(int32_t vertex, Point new_rate, int64_t tick)
{
  const size_t i = (size_t)vertex;
  Bent &b = bent_of(vertex);
  b.path += length_of((tick - b.since) * rate[i]);
  b.since = (int32_t)tick;
  origin[i] = at_tick(at_tick(origin[i], rate[i], tick), new_rate, -tick);
  rate[i] = new_rate;
  beyond = std::max(beyond, std::sqrt(list.moved(vertex, at_tick(origin[i], new_rate, ticks))));
  const Point whole = at_tick(origin[i], new_rate, ticks) - (*position)[i];
  if (length_of(whole) >= 0.5 * (double)std::min({model.cells[0], model.cells[1], model.cells[2]}))
    throw Stopped("a vertex would move by half the shortest edge or more");
}

void EventDrift::answer(const Event &event)
{
  const int32_t vertex[4] = {event.bond, model.next[(size_t)event.bond], event.other, model.next[(size_t)event.other]};
  const Flight3 f = flight_of(event.bond, event.other, event.image);
  Vector v[4];
  for (int k = 0; k < 4; k++)
    v[k] = (*velocity)[(size_t)vertex[k]];
  Contact contact;
  if (!find_contact(at_tick(f.p, f.p_rate, event.tick), at_tick(f.q, f.q_rate, event.tick),
                    at_tick(f.w, f.w_rate, event.tick), v, contact)) {
    Event again = event;
    again.tick = (int32_t)first_contact(f, event.tick + 1);
    if (again.tick < ticks)
      events.push(again);
    return;
  }
  bool worn = false;
  for (const int32_t j : vertex) {
    const int32_t number = bent_number[(size_t)j];
    worn = worn || (number && (bent[(size_t)number - 1].cluster || bent[(size_t)number - 1].contacts >= most_contacts));
  }
  if (worn || !exchange(event, vertex, contact))
    freeze(event, vertex);
}

bool EventDrift::exchange(const Event &event, const int32_t vertex[4], const Contact &contact)
{
  const auto place = [&](int32_t j) { return at_tick(origin[(size_t)j], rate[(size_t)j], event.tick); };
  Ends ends;
  for (int k = 0; k < 4; k++) {
    ends.velocity[k] = (*velocity)[(size_t)vertex[k]];
    ends.force[k] = fibers.force_on(vertex[k], place);
    ends.mass[k] = model.mass[(size_t)vertex[k]];
  }
  double momentum;
  if (impulse(ends, contact, start + time * ((double)event.tick * 0x1p-16), momentum) == NO_IMPULSE)
    return false;
  for (int k = 0; k < 4; k++) {
    (*velocity)[(size_t)vertex[k]] = ends.velocity[k];
    bend(vertex[k], rate_of(time, ends.velocity[k]), event.tick);
    bent_of(vertex[k]).contacts++;
  }
  if (rows)
    rows->push_back(
        {event.bond, event.other, {event.image[0], event.image[1], event.image[2]}, event.tick, contact, momentum});
  search_again({vertex, vertex + 4}, event.tick);
  return true;
}

// The last resort: a cluster with one rate until the drift ends.
void EventDrift::freeze(const Event &event, const int32_t vertex[4])
{
  Point common = {0, 0, 0};
  bool led = false;
  for (int k = 0; k < 4; k++)
    if (!led && bent_of(vertex[k]).cluster)
      common = rate[(size_t)vertex[k]], led = true;
  for (int k = 0; k < 4 && !led; k++)
    common = common + rate[(size_t)vertex[k]];
  if (!led)
    common = {common.x / 4, common.y / 4, common.z / 4};
  const int32_t number = ++clusters;
  int32_t old[4];
  for (int k = 0; k < 4; k++) {
    old[k] = bent_of(vertex[k]).cluster;
    bent_of(vertex[k]).cluster = number;
  }
  std::vector<int32_t> members;
  for (Bent &b : bent) {
    for (const int32_t k : old)
      if (k && b.cluster == k)
        b.cluster = number;
    if (b.cluster == number)
      members.push_back(b.vertex);
  }
  for (const int32_t j : members)
    bend(j, common, event.tick);
  search_again(members, event.tick);
}

// Drops the events of all bonds of these vertices, and searches their pairs anew.
void EventDrift::search_again(const std::vector<int32_t> &vertices, int64_t tick)
{
  std::vector<int32_t> bonds;
  for (const int32_t j : vertices)
    for (const int32_t bond : {j, model.prev[(size_t)j]})
      if (bond >= 0 && model.next[(size_t)bond] >= 0)
        bonds.push_back(bond);
  std::sort(bonds.begin(), bonds.end());
  bonds.erase(std::unique(bonds.begin(), bonds.end()), bonds.end());
  for (const int32_t bond : bonds)
    version[(size_t)bond]++;
  std::vector<Event> found;
  for (const int32_t bond : bonds)
    for (int32_t k = list.first[(size_t)bond]; k < list.first[(size_t)bond + 1]; k++) {
      const Near &other = list.near[(size_t)k];
      if (other.other > bond || !std::binary_search(bonds.begin(), bonds.end(), other.other))
        search_pair(other.pair, tick, found);
    }
  for (const Event &event : found)
    events.push(event);
}
