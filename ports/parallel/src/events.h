// A drift of all vertices at once: docs/porting.md, "Contacts at their own time", *Events* and *Clusters*.
#pragma once

#include <queue>
#include <vector>

#include "contact.h"
#include "fibers.h"
#include "pairs.h"
#include "stopped.h"

// A contact that was answered.
struct ContactRow {
  int32_t bond, other, image[3];
  int64_t tick;
  Contact contact;
  double momentum;
};

class EventDrift
{
public:
  EventDrift(const Model &model, const Fibers &fibers) : model(model), fibers(fibers), list(model)
  {
  }

  // `start` is the time from the middle between two kicks to the beginning. Rows are appended.
  void drift(double time, double start, std::vector<Point> &position, std::vector<Vector> &velocity,
             std::vector<ContactRow> *rows);

private:
  // A contact to come. Out of date if the bonds' versions have changed.
  struct Event {
    int32_t tick, bond, other, image[3];
    uint32_t version;
  };
  struct Later {
    bool operator()(const Event &a, const Event &b) const;
  };
  struct Bent {
    int32_t vertex;
    int32_t contacts, cluster; // cluster 0: none
    double path;               // flown on pieces that are over, a0
    int32_t since;             // tick at which this piece began
  };

  bool fly(double time, double start, std::vector<ContactRow> *rows);
  void take_off(double time);
  void renew_list(double need);
  void search_list();
  void search_pair(int32_t number, int64_t from, std::vector<Event> &found) const;
  Flight3 flight_of(int32_t bond, int32_t other, const int32_t *image) const;
  void answer(const Event &event);
  bool exchange(const Event &event, const int32_t vertex[4], const Contact &contact);
  void freeze(const Event &event, const int32_t vertex[4]);
  void bend(int32_t vertex, Point rate, int64_t tick);
  Bent &bent_of(int32_t vertex);
  void search_again(const std::vector<int32_t> &vertices, int64_t tick);
  void land();

  const Model &model;
  const Fibers &fibers;
  PairList list;
  std::vector<double> pair_due;    // by when, in `path` of both bonds, a pair must be looked at again
  std::vector<double> path, flown; // of each bond: the longer way of its ends until now, and in this drift
  std::vector<uint32_t> version;
  std::vector<Point> origin, rate;
  std::vector<int32_t> bent_number; // of a vertex, 0: flies straight
  std::vector<Bent> bent;
  std::priority_queue<Event, std::vector<Event>, Later> events;
  std::vector<Point> *position = nullptr;
  std::vector<Vector> *velocity = nullptr;
  std::vector<ContactRow> *rows = nullptr;
  double time = 0, start = 0, margin = 0, beyond = 0; // beyond: how far from its reference a vertex would come
  int32_t clusters = 0;
};
