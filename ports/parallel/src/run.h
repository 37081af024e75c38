// Whole steps: docs/port/contract.md, "A step"; docs/conventions.md, "Order of operations".
#pragma once

#include <functional>
#include <string>

#include "events.h"
#include "fibers.h"
#include "model.h"
#include "solvent.h"
#include "sweep.h"

class Run
{
public:
  Run(const Model &model, State &state, const Settings &settings);
  void steps(int64_t number);
  // The state of now, by ids.
  const State &now();
  const DriftCounts &contact_counts() const
  {
    return contacts.counts;
  }
  // Contacts since they were last cleared, if asked for.
  std::vector<ContactRow> *rows = nullptr;
  // Called after each stage with its name, and the number of the step in progress.
  std::function<void(uint64_t, const char *)> after_stage;

private:
  void one_step();
  void drift(uint64_t number, double time, uint32_t which);
  void collide(uint64_t number);
  void force(uint64_t number);
  void kick(uint64_t number, double time);
  void told(uint64_t number, const char *stage);

  const Model &model;
  State &state;
  Solvent solvent;
  uint64_t last = 0; // step of this call of `steps`
  CollisionCounts before; // this run
  Fibers fibers;
  EventDrift contacts; // by the rule event-driven
  Sweep sweep;         // by the rule sequential, or where fibers may cross
  std::vector<Vector> forces;
};
