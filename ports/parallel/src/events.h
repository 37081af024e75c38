// A drift of all vertices at once: docs/port/contacts.md, *Events* and *Clusters*; docs/port/parallel.md, *Components*.
#pragma once

#include <vector>

#include "component.h"
#include "stopped.h"

// A contact that was answered by an impulse.
struct ContactRow {
  int32_t bond, other, image[3];
  int64_t tick;
  Contact contact;
  double momentum;
};

// Since the start: first contacts of drifts, components, how many were joined to others, the most answers of one, lists
// of pairs. With one thread a drift has one component.
struct DriftCounts {
  int64_t events = 0, components = 0, largest = 0, joined = 0, lists = 0;
  int64_t executed = 0, softened = 0, rigid = 0; // answers: by an impulse, by a weakened one, by a cluster
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
  DriftCounts counts;

private:
  double take_off(double time);
  double furthest() const;
  void renew_list(double need);
  bool fly(const Flights &flights, double straight);
  void search_list(const Flights &flights);
  void part_events();
  void work(const Flights &flights, const std::vector<int32_t> &numbers);
  bool join_components();
  void find_meetings(int32_t number, std::vector<std::pair<int32_t, int32_t>> &meetings) const;
  bool boxes_meet(const Box &a, int32_t other, const int32_t *image) const;
  Box box_of(int32_t bond) const;
  void merge(const std::vector<std::pair<int32_t, int32_t>> &pairs);
  void land(std::vector<Vector> &velocity);
  void tell(std::vector<ContactRow> &rows) const;

  const Model &model;
  const Fibers &fibers;
  PairList list;
  std::vector<Point> *position = nullptr;
  const std::vector<Vector> *velocity = nullptr;
  std::vector<Point> rate;
  std::vector<double> way;   // of each vertex in this drift, if it flies straight
  std::vector<double> due;   // by when, in `path` of both bonds, a pair must be looked at again
  std::vector<double> path;  // of each bond: the longer way of its ends until now
  std::vector<double> reach; // the same with this drift, if it flies straight
  std::vector<Event> found;  // contacts if all fly straight
  std::vector<Component> components;
  std::vector<Worker> workers; // of each thread
  std::vector<int32_t> owner;  // of each vertex: 1 + component that answers for it, or 0
  std::vector<int32_t> place;  // of each vertex in its owner's list
  double margin = 0;
  double away = 0; // upper bound of the distances of vertices from their references, a0
};
