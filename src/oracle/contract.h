/* Which scenes the contract of ports covers (docs/port/contract.md). */
#ifndef UNCROSS_ORACLE_CONTRACT_H
#define UNCROSS_ORACLE_CONTRACT_H

#include "oracle/operators.h"
#include "scene/scene.h"

/* False, with a message, for a scene whose operators (packs: true), or whose whole steps, the contract does not have.
 */
bool contract_covers(const struct scene *scene, bool packs, struct message *message);

/* scene_start for a scene that ports run: without what no start says. */
bool contract_start(struct scene *scene, struct state *state, struct work *work, struct message *message);

#endif
