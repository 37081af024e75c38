#include "component.h"

#include <algorithm>

constexpr int most_contacts = 1000;

bool is_earlier(const Event &a, const Event &b)
{
  if (a.tick != b.tick)
    return a.tick < b.tick;
  if (a.bond != b.bond)
    return a.bond < b.bond;
  if (a.other != b.other)
    return a.other < b.other;
  return std::lexicographical_compare(a.image, a.image + 3, b.image, b.image + 3);
}

Point rate_of(double time, Vector velocity)
{
  return nearest(0x1p24 * (time * velocity));
}

double length_of(Point a)
{
  const Vector r = in_a0(a);
  return std::sqrt(dot(r, r));
}

void Worker::run(const Flights &flights, Component &component)
{
  all = &flights, mine = &component;
  const size_t n = (size_t)flights.model.vertices();
  bent_number.resize(n, 0), version.resize(n, 0);
  mine->bent.clear(), mine->answered.clear();
  mine->beyond = 0.0, mine->late = mine->fails = false;
  clusters = 0;
  events = component.first;
  for (Event &event : events)
    event.version = version[event.bond] + version[event.other];
  std::make_heap(events.begin(), events.end(), Later());
  while (!events.empty() && !mine->late && !mine->fails) {
    const Event event = events.front();
    std::pop_heap(events.begin(), events.end(), Later());
    events.pop_back();
    if (event.version == version[event.bond] + version[event.other])
      answer(event);
  }
  for (Bent &b : mine->bent) {
    b.box.add(at_tick(b.origin, b.rate, ticks));
    b.path += length_of((ticks - b.since) * b.rate);
    bent_number[b.vertex] = 0;
  }
}

void Worker::push(const Event &event)
{
  events.push_back(event);
  std::push_heap(events.begin(), events.end(), Later());
}

Flight3 Worker::flight_of(int32_t bond, int32_t other, const int32_t *image) const
{
  const int32_t i1 = all->model.next[bond], j1 = all->model.next[other];
  const Point edge = all->model.edge(), shift = {image[0] * edge.x, image[1] * edge.y, image[2] * edge.z};
  const Point i = origin(bond), j = origin(other), i_rate = rate(bond), j_rate = rate(other);
  return {origin(i1) - i, origin(j1) - j, (j + shift) - i, rate(i1) - i_rate, rate(j1) - j_rate, j_rate - i_rate};
}

Bent &Worker::bent_of(int32_t vertex)
{
  int32_t &number = bent_number[vertex];
  if (!number) {
    const Point at = all->origin[vertex];
    mine->bent.push_back({vertex, 0, 0, 0, 0.0, at, all->rate[vertex], all->velocity[vertex], {at, at}});
    number = (int32_t)mine->bent.size();
  }
  return mine->bent[number - 1];
}

// A new rate, with the place at this tick kept.
void Worker::bend(int32_t vertex, Point new_rate, int64_t tick)
{
  Bent &b = bent_of(vertex);
  b.box.add(at_tick(b.origin, b.rate, tick + 1));
  b.path += length_of((tick - b.since) * b.rate);
  b.since = (int32_t)tick;
  b.origin = at_tick(at_tick(b.origin, b.rate, tick), new_rate, -tick);
  b.rate = new_rate;
  b.box.add(at_tick(b.origin, b.rate, tick));
  const Point end = at_tick(b.origin, new_rate, ticks);
  mine->beyond = std::max(mine->beyond, std::sqrt(all->list.moved(vertex, end)));
  mine->late = 2.0 * mine->beyond + all->margin > all->list.skin;
  mine->fails = mine->fails || length_of(end - all->origin[vertex]) >= all->limit;
}

void Worker::answer(const Event &event)
{
  const Model &model = all->model;
  const int32_t vertex[4] = {event.bond, model.next[event.bond], event.other, model.next[event.other]};
  const Flight3 f = flight_of(event.bond, event.other, event.image);
  Vector v[4];
  bool worn = false;
  for (int k = 0; k < 4; k++) {
    const Bent &b = bent_of(vertex[k]);
    v[k] = b.velocity;
    worn = worn || b.cluster || b.contacts >= most_contacts;
  }
  Contact contact;
  if (!find_contact(at_tick(f.p, f.p_rate, event.tick), at_tick(f.q, f.q_rate, event.tick),
                    at_tick(f.w, f.w_rate, event.tick), v, contact)) {
    Event again = event;
    again.tick = (int32_t)first_contact(f, event.tick + 1);
    mine->answered.push_back({event, false, {}, 0.0, NO_IMPULSE, false});
    if (again.tick < ticks)
      push(again);
    return;
  }
  if (worn || !exchange(event, vertex, contact))
    freeze(event, vertex);
}

bool Worker::exchange(const Event &event, const int32_t vertex[4], const Contact &contact)
{
  const auto place = [&](int32_t j) { return at_tick(origin(j), rate(j), event.tick); };
  Ends ends;
  for (int k = 0; k < 4; k++) {
    ends.velocity[k] = velocity(vertex[k]);
    ends.force[k] = all->fibers.force_on(vertex[k], place);
    ends.mass[k] = all->model.mass[vertex[k]];
  }
  double momentum;
  const Answer answer =
      impulse(ends, contact, all->start + all->time * ((double)event.tick * 0x1p-16), momentum);
  if (answer == NO_IMPULSE)
    return false;
  for (int k = 0; k < 4; k++) {
    bend(vertex[k], rate_of(all->time, ends.velocity[k]), event.tick);
    Bent &b = bent_of(vertex[k]);
    b.velocity = ends.velocity[k];
    b.contacts++;
  }
  mine->answered.push_back({event, true, contact, momentum, answer, false});
  search_again(vertex, 4, event.tick);
  return true;
}

// The last resort: a cluster with one rate until the drift ends.
void Worker::freeze(const Event &event, const int32_t vertex[4])
{
  Point common = {0, 0, 0};
  bool led = false;
  for (int k = 0; k < 4; k++)
    if (!led && bent_of(vertex[k]).cluster)
      common = rate(vertex[k]), led = true;
  for (int k = 0; k < 4 && !led; k++)
    common = common + rate(vertex[k]);
  if (!led)
    common = {common.x / 4, common.y / 4, common.z / 4};
  const int32_t number = ++clusters;
  int32_t old[4];
  for (int k = 0; k < 4; k++) {
    old[k] = bent_of(vertex[k]).cluster;
    bent_of(vertex[k]).cluster = number;
  }
  std::vector<int32_t> members;
  for (Bent &b : mine->bent) {
    for (const int32_t k : old)
      if (k && b.cluster == k)
        b.cluster = number;
    if (b.cluster == number)
      members.push_back(b.vertex);
  }
  for (const int32_t j : members)
    bend(j, common, event.tick);
  mine->answered.push_back({event, false, {}, 0.0, NO_IMPULSE, true});
  search_again(members.data(), members.size(), event.tick);
}

void Worker::search_pair(int32_t number, int64_t from)
{
  const Pair &p = all->list.pairs[number];
  const int64_t tick = first_contact(flight_of(p.bond, p.other, p.image), from);
  if (tick < ticks)
    push({(int32_t)tick, p.bond, p.other, {p.image[0], p.image[1], p.image[2]}, version[p.bond] + version[p.other]});
}

// Drops the events of all bonds of these vertices, and searches their pairs anew.
void Worker::search_again(const int32_t *vertex, size_t count, int64_t tick)
{
  const Model &model = all->model;
  bonds.clear();
  for (size_t k = 0; k < count; k++)
    for (const int32_t bond : {vertex[k], model.prev[vertex[k]]})
      if (bond >= 0 && model.next[bond] >= 0)
        bonds.push_back(bond);
  std::sort(bonds.begin(), bonds.end());
  bonds.erase(std::unique(bonds.begin(), bonds.end()), bonds.end());
  for (const int32_t bond : bonds)
    version[bond]++;
  for (const int32_t bond : bonds)
    for (int32_t k = all->list.first[bond]; k < all->list.first[bond + 1]; k++) {
      const Near &other = all->list.near[k];
      if (other.other > bond || !std::binary_search(bonds.begin(), bonds.end(), other.other))
        search_pair(other.pair, tick);
    }
}
