/*
 * Bonds that must not cross: the scratch of this room, and the stage that it adds to a step. A drift moves all
 * vertices. The crossing rule (rule.h) decides what happens where bonds would cross.
 */
#ifndef UNCROSS_CONTACT_CONTACT_H
#define UNCROSS_CONTACT_CONTACT_H

#include "contact/event_queue.h"
#include "contact/line.h"
#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"
#include "wall/wall.h"

/* What a drift's moves refer to: see contact/drift.h. */
struct drift_frame {
  double time, start;    /* t0: of the drift; from the middle of the step to its beginning */
  struct vec3 velocity;  /* of the frame of the moves, a0/t0 */
  struct slit slit;      /* the walls */
  double image_speed;    /* along x, of the image beyond y = L relative to the box, a0/t0; 0: the box is not sheared */
  bool sheared;          /* moves are made in sheared coordinates; else the rest is not used */
  double strain, growth; /* at the end of the drift; by which it has grown in the drift */
  int64_t slid, slides;  /* of the image beyond y = L, at the start and the end, lattice units, from -Lx/2 on */
  int64_t edge, middle;  /* of the box along y, lattice units */
};

/* Another bond that may be touched: its number, and which periodic image of it, in box edges. */
struct neighbor {
  int32_t bond;
  int32_t image[3];
};

struct neighbor_list {
  uint32_t count, room;
  struct neighbor *at;
};

/* A candidate contact: two bonds that may touch in this drift. Each of the two has an entry, with the other in `with`.
 */
struct candidate {
  uint32_t bond;
  struct neighbor with;
  uint32_t next; /* 1 + the number of the bond's next candidate, or 0 */
};

struct candidate_list {
  uint32_t count, room;
  struct candidate *at;
  uint32_t *first; /* [bonds] as `next` */
};

/* The reference position of a vertex: where it stood when its bonds last searched for partners. */
struct reference_position {
  struct point at; /* unwrapped */
  double skin;     /* a0: the distance from there that the vertex may have */
};

struct image {
  int32_t k[3]; /* in box edges */
};

/* The pair list (contact/pairs.h). A pair can touch only when the sum of its two bonds' paths exceeds its limit.
 */
struct pair_list {
  uint32_t count, room;
  uint32_t *bond, *other;
  uint32_t *limit; /* as path, below, modulo 2^32 */
  struct pair_detail {
    struct image image;  /* of the other bond */
    uint32_t generation; /* sum of both bonds' when the pair was found; if it is larger now, the pair is out of date */
  } * detail;            /* read only where the pair is due */
};

/* Entries that a row of the grid holds itself; a longer row is allocated elsewhere. */
enum { SEARCH_FIRST_ENTRIES = 15 };

/* A bond that touches a search cell. */
struct grid_entry {
  uint64_t key; /* the part of the box around the bond that lies in the cell: contact/search_cells.h */
  struct grid_bond {
    int32_t bond;
    int8_t image[3]; /* of the bond that lies there; 0: the image of its first end's reference position */
    int8_t zero;     /* no hole in the struct: entries are compared as a whole */
  } is;
};

/* Bonds that touch a search cell. The first few stand in the row itself: four cache lines in all. */
struct grid_row {
  _Alignas(64) struct grid_entry *at;
  uint32_t count, room;
  struct grid_entry first[SEARCH_FIRST_ENTRIES];
};

struct neighbors {
  bool built;
  struct reference_position *reference; /* [vertices] */
  uint32_t *path; /* [vertices] bound on the way that both ends of bond j have gone, in units of 2^-20 a0, modulo 2^32.
                     Where vertex j has no bond j, its own way. */
  uint32_t *generation; /* [vertices] number of searches of bond j for partners */
  uint32_t *hold; /* [vertices] how far vertex j may still go before its skin is looked at, in the same units. In a
                     drift it may fall below 0, modulo 2^32: the skin is looked at then (contact/renewals.h). */
  struct pair_list pairs;
  int32_t cells[3];     /* of the search grid */
  int64_t cell_edge[3]; /* lattice units */
  int cell_shift[3];    /* 2^cell_shift is about 1/128 of cell_edge */
  struct {
    double cells, cell_edge, box_edge;
  } inverse[3]; /* of the number of cells, and of edges in lattice units */
  uint32_t cell_count;
  double around,
      apart; /* a0: what boxes and pairs of capsules have beyond skins: half of the thickness, all of it; and slack */
  struct grid_row *entries; /* [cell_count] */
  struct point moved;       /* displacement of the frame of the moves since reference positions were first taken */
  uint64_t renewed;         /* number of reference positions taken so far, for benchmarks */
};

/* A vertex that has changed its flight in this drift (contact/event_driven.c). */
struct bend_in_path {
  uint32_t vertex;
  struct point start; /* its place at the start of the drift */
  struct point rate;  /* its displacement in a tick, lattice units */
  struct point end;   /* its place at the end, once the drift has ended */
  uint32_t contacts;  /* number of contacts of its bonds, and of its hits of walls, that were answered in this drift */
  uint32_t cluster;   /* of a rigid cluster: the number of its first member in the list, + 1; else 0 */
};

struct bend_list {
  uint32_t count, room;
  struct bend_in_path *at;
};

/* The flights of a drift in which all vertices move at once. At tick T, vertex i is at position[i] + T rate. The rate
 * follows from its velocity, or is in `bends`. */
struct flights {
  uint32_t *version;      /* [vertices] of bond j: number of changes of the flights of its ends */
  uint32_t *bend_of;      /* [vertices] 1 + its place in `bends`, or 0 */
  struct bend_list bends; /* kept until the next drift begins, for tests */
  struct event_queue queue;
};

struct event_drift;

/* Another body that flies among the bonds in a drift of the rule `event-driven`, and meets them. A higher room gives it
 * to struct contact. What comes next to it is answered between the contacts of bonds. Functions that return bool return
 * false, with the fault recorded, as event_steer (contact/event_drift.h). */
struct timeline {
  void *body;
  bool (*begin)(const struct event_drift *d);   /* it sets out; its first contacts are searched */
  int32_t (*next)(const struct event_drift *d); /* the tick of what comes next; FLIGHT_TICKS: nothing does */
  bool (*answer)(const struct event_drift *d);  /* to that */
  bool (*search_again)(const struct event_drift *d, uint32_t n, const uint32_t *bond, int32_t tick); /* bonds bend */
  void (*end)(const struct event_drift *d);
  struct point (*rate)(const struct event_drift *d);       /* its displacement in a tick, now */
  bool (*hold)(const struct event_drift *d, int32_t tick); /* it stands until the drift ends; its velocity stays */
  uint32_t cluster;                                        /* of the vertices that move rigidly with it; 0: none */
};

/* The force on a vertex of a fiber whose vertices stand at place(context, vertex), kT/a0. */
typedef struct vec3 contact_force(const struct model *model, uint32_t vertex,
                                  struct point (*place)(const void *context, uint32_t vertex), const void *context);

/* A vertex that hits a wall in a drift in which vertices move freely (contact/wall.h). */
struct wall_bounce {
  uint32_t vertex;
  enum wall wall;
  struct point end;     /* its place at the end of the drift */
  struct vec3 velocity; /* after the hit, a0/t0 */
};

struct wall_bounces {
  uint32_t count, room;
  struct wall_bounce *at;
};

struct contact {
  contact_force *force;     /* given by the caller of contact_alloc */
  struct drift_frame frame; /* of the drift at hand, or the last one */
  struct wall_bounces bounces;
  struct flights flights; /* rules that move all at once, else NULL */
  uint32_t *order;        /* [vertices] in which vertices move in this drift */
  uint32_t *rank;         /* [vertices] order[rank[i]] = i. This and order, queue, waits, turns: rules in turns */
  uint32_t *range; /* [vertices] bound on the distance that a vertex goes in this drift, units of paths. Range and
                      candidates.first: rules that forbid crossing, else NULL */
  uint32_t *queue; /* [vertices] vertices that wait for their turns, in this order; `queued` of them */
  uint32_t queued;
  uint8_t *waits;  /* [vertices] 1: moves at its turn, 0: moves at once */
  uint64_t *turns; /* [vertices / 64, rounded up] scratch: bit k is set if the vertex of rank k waits */
  struct candidate_list candidates;
  struct neighbor_list near; /* scratch */
  struct neighbors neighbors;
  struct timeline *beside; /* NULL: bonds are alone */
  struct vec3 *aside;      /* [vertices] models with held vertices, else NULL: contact/held.h */
  uint64_t waited,
      called_back; /* number of moves so far that waited for their turn; of these, called back. For benchmarks */
};

/* Allocates the scratch for the drifts of this model; with `everything`, also what only other models need, for code
 * that calls the parts of a drift by itself. False if memory is short. */
bool contact_alloc(struct contact *contact, const struct model *model, contact_force *force, bool everything);
void contact_free(struct contact *contact);

/* For whoever has put vertices elsewhere: the next drift searches for partners anew. A drift knows only how far
 * vertices fly; without this it would take those of their old places for all that there are, and miss contacts. */
static inline void contact_forget_places(struct contact *contact)
{
  contact->neighbors.built = false;
}

/* Bytes that contact_alloc and the first drift allocate, before lists grow. */
uint64_t contact_bytes(const struct model *model);

/* A hit that a trial move found, and the answer to it. */
struct contact_event {
  uint32_t vertex;      /* that tried to move */
  uint32_t moving_bond; /* its first vertex */
  uint32_t standing_bond;
  int32_t image[3]; /* of the standing bond, in box edges */
  struct crossing_hit hit;
  bool executed;  /* true for the first of this move's hits; the others have no effect */
  double impulse; /* dP, m a0/t0, if executed; else 0 */
  double gap;     /* between the points of contact of two bonds that move at once, a0: that of their tubes; else 0 */
};

/* Receives each hit, for oracles, tests, and observables of what contacts hand on. NULL: nobody asks. */
struct contact_log {
  void (*record)(void *context, const struct contact_event *event);
  void *context;
};

/* A drift: all vertices move for a time fraction * dt, under the crossing rule. drift: its number within the step, 0
 * or 1. False, with the fault recorded, if a vertex would move further than half the shortest edge, if one is beyond
 * LATTICE_REACH (checked now and then only), or if memory is short. */
bool contact_drift(struct state *state, const struct model *model, struct contact *contact, double fraction,
                   uint64_t step, uint32_t drift, const struct contact_log *log, struct fault *fault);

/* The same in this frame, of any time. */
bool contact_drift_in(const struct drift_frame *frame, struct state *state, const struct model *model,
                      struct contact *contact, uint64_t step, uint32_t drift, const struct contact_log *log,
                      struct fault *fault);

/* Appends a drift to a plan, if the model has vertices. room: offset of struct contact in struct work. */
struct plan;
void contact_plan_drift(struct plan *plan, const struct model *model, size_t room, double fraction, uint32_t drift);

#endif
