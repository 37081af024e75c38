// Components of a drift by the rule event-driven: docs/port/parallel.md, *Components*. Each is
// worked on serially, as if all other vertices flew straight on. So components need nothing of each other, and threads
// work on them at once.
#pragma once

#include <string>
#include <vector>

#include "contact.h"
#include "fibers.h"
#include "pairs.h"

// A contact to come. Out of date if the bonds' versions have changed.
struct Event {
  int32_t tick, bond, other, image[3];
  uint32_t version;
};

bool is_earlier(const Event &a, const Event &b);

// An event that was answered. told: by an impulse; rigid: by a cluster.
struct Answered {
  Event event;
  bool told;
  Contact contact;
  double momentum;
  Answer answer;
  bool rigid;
};

// All places of a vertex in a drift, each straight piece of its path taken a tick further than it is flown.
struct Box {
  Point low, high;

  void add(Point p)
  {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
};

// A vertex that a component answers for.
struct Bent {
  int32_t vertex;
  int32_t contacts, cluster; // cluster 0: none
  int32_t since;             // tick at which this piece began
  double path;               // flown on pieces that are over, a0
  Point origin, rate;
  Vector velocity;
  Box box;
};

struct Component {
  std::vector<Event> first; // found from tick 0 on
  std::vector<Bent> bent;
  std::vector<Answered> answered;
  double beyond = 0;  // how far from its reference a vertex comes
  bool late = false;  // the list of pairs is too narrow
  bool fails = false; // a vertex would move by half the shortest edge
};

// What all components of a drift share, and do not change.
struct Flights {
  const Model &model;
  const Fibers &fibers;
  const PairList &list;
  const Point *origin, *rate; // of each vertex, if it flies straight
  const Vector *velocity;
  double time, start, margin, limit;
  bool with_rows;

  Flight3 straight(int32_t bond, int32_t other, const int32_t *image) const
  {
    const int32_t i1 = model.next[bond], j1 = model.next[other];
    const Point edge = model.edge(), shift = {image[0] * edge.x, image[1] * edge.y, image[2] * edge.z};
    return {origin[i1] - origin[bond], origin[j1] - origin[other], (origin[other] + shift) - origin[bond],
            rate[i1] - rate[bond],     rate[j1] - rate[other],     rate[other] - rate[bond]};
  }
};

Point rate_of(double time, Vector velocity);
double length_of(Point a);

// Works on one component after the other.
class Worker
{
public:
  void run(const Flights &flights, Component &component);

private:
  struct Later {
    bool operator()(const Event &a, const Event &b) const
    {
      return is_earlier(b, a);
    }
  };

  Point origin(int32_t vertex) const
  {
    const int32_t number = bent_number[vertex];
    return number ? mine->bent[number - 1].origin : all->origin[vertex];
  }
  Point rate(int32_t vertex) const
  {
    const int32_t number = bent_number[vertex];
    return number ? mine->bent[number - 1].rate : all->rate[vertex];
  }
  Vector velocity(int32_t vertex) const
  {
    const int32_t number = bent_number[vertex];
    return number ? mine->bent[number - 1].velocity : all->velocity[vertex];
  }
  Flight3 flight_of(int32_t bond, int32_t other, const int32_t *image) const;
  Bent &bent_of(int32_t vertex);
  void push(const Event &event);
  void answer(const Event &event);
  bool exchange(const Event &event, const int32_t vertex[4], const Contact &contact);
  void freeze(const Event &event, const int32_t vertex[4]);
  void bend(int32_t vertex, Point rate, int64_t tick);
  void search_pair(int32_t number, int64_t from);
  void search_again(const int32_t *vertex, size_t count, int64_t tick);

  const Flights *all = nullptr;
  Component *mine = nullptr;
  std::vector<int32_t> bent_number; // of a vertex, 0: flies straight
  std::vector<uint32_t> version;    // of a bond
  std::vector<Event> events;        // a heap
  std::vector<int32_t> bonds;       // scratch
  int32_t clusters = 0;
};
