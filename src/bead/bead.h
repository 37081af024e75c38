/*
 * The bead on its way: the scratch of this room, and what it adds to a step. system/bead.h says what a bead is.
 *
 * In a drift the bead, the solvent particles that it may meet and the bonds have one timeline: flight.c has the bead
 * among particles, company.c among bonds. The collision that follows gives all of them their places (collide.c), and
 * the cells that the surface cuts their virtual particles (matter.c). The rooms below know an obstacle (mpc/border.h)
 * and a body among bonds (contact/contact.h) only.
 */
#ifndef UNCROSS_BEAD_BEAD_H
#define UNCROSS_BEAD_BEAD_H

#include "bead/flight.h"
#include "contact/contact.h"
#include "mpc/border.h"

/* A bond that may touch the bead in this drift. */
struct bead_neighbor {
  uint32_t bond;
  int32_t due;        /* the tick of its next contact; FLIGHT_TICKS: none */
  struct point image; /* of the bead that it may touch, from the bead itself */
};

/* The bead among bonds: company.h. */
struct bead_company {
  uint32_t *limit;          /* [vertices] bond j cannot touch it before path[j] and its own way together exceed this */
  uint32_t *listed;         /* [vertices] 1 + place of bond j in the list, or 0 */
  uint32_t way, way_before; /* bound on the way that the bead has gone; without this drift; units of paths */
  uint32_t count, room;
  struct bead_neighbor *at;
  double slack; /* a0: of the bead's free flight, as the way is reckoned */
  bool stale;   /* the next hit has to be looked for */
  int32_t hit;  /* its tick */
};

/* A cell that the surface cuts, and that has members. */
struct bead_cut {
  uint32_t cell, n; /* place in sum and turn; particles inside */
  struct virtual_members members;
};

struct bead_cuts {
  uint32_t count, room;
  struct bead_cut *cut;
  uint32_t *number;    /* [count] numbers of the cells */
  struct vec3 *normal; /* [count] the normal deviates of their virtual particles */
};

struct bead_work {
  struct bead_flight flight;
  struct bead_company company;
  struct bead_cuts cuts;
  struct obstacle obstacle; /* as collisions see it */
  struct timeline timeline; /* as bonds do */
};

/* Allocates the scratch for the bead of this model; NULL without one. It stays at its place until it is freed. False if
 * memory is short. */
bool bead_alloc(struct bead_work **work, const struct model *model);
void bead_free(struct bead_work *work);

/* Bytes that bead_alloc allocates. */
uint64_t bead_bytes(const struct model *model);

/* Tells the rooms below of the bead, if there is one. */
void bead_join(struct bead_work *work, struct mpc *mpc, struct contact *contact);

/* Appends the flight of a bead that is alone in the solvent. room: offset of the pointer to its scratch in struct work.
 * Among fibers it flies in their drift. */
struct plan;
void bead_plan_drift(struct plan *plan, const struct model *model, size_t room);

/* Puts the bead at its place, with a velocity from the Maxwell distribution, and solvent particles that stand inside of
 * it to others. */
void bead_start(struct state *state, const struct model *model);

#endif
