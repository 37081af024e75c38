/* What a scene may say: the tables of its keys, and the draft that they fill. */
#ifndef UNCROSS_SCENE_KEYS_H
#define UNCROSS_SCENE_KEYS_H

#include "io/keys.h"
#include "io/scene.h"

#define SCENE_MOST_BENDING 1e9 /* kT, given or derived */
#define SCENE_MOST_FLOW 100.0  /* a0/t0, each component */

/* A scene as it is read: the scene itself, and what is turned into something else once all is read. */
struct draft {
  struct scene scene;
  double collision_interval; /* dt_c, becomes interval_steps */
  struct key_list fibers;    /* of struct draft_kind */
};

struct draft_kind {
  struct fiber_kind kind;
  double persistence_length; /* l_p, becomes bending */
  struct key_list places;    /* of struct draft_place */
};

struct draft_place {
  struct vec3 center, direction;
};

/* The top level, into a struct draft. */
extern const struct key_table scene_top_table;

/* Words of the choices, in the order of their enums, ended by NULL. */
extern const char *const scene_bath_words[];
extern const char *const scene_order_words[], *const scene_thermostat_words[], *const scene_exclusion_words[],
                                                                                   *const scene_refusal_words[],
                                                                                       *const scene_frame_words[],
                                                                                           *const scene_start_words[];

#endif
