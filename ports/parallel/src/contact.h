// Where two bonds touch, and the impulse: docs/port/contacts.md, *The contact*, *The impulse*.
#pragma once

#include "flight.h"

struct Contact {
  double s, t;
  Vector normal;
};

// Velocities, forces and masses of i, next[i], j, next[j].
struct Ends {
  Vector velocity[4], force[4];
  double mass[4];
};

enum Answer { NO_IMPULSE = 0, FULL = 1, SOFTENED = 2 };

// False if the bonds touch already.
bool find_contact(Point p, Point q, Point w, const Vector velocity[4], Contact &contact);
// Changes the four velocities.
Answer impulse(Ends &ends, const Contact &contact, double tau, double &momentum);
