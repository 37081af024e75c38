/*
 * Inside the oracle: sweeps, replayed from the inputs of a pack with one thing changed. A wrong exchange changes the
 * moves that follow, so a guess must make all of their events, and where all vertices end. If none does, each of their
 * moves is judged alone, in the state that their own events before it have made.
 */
#ifndef UNCROSS_ORACLE_REPLAY_H
#define UNCROSS_ORACLE_REPLAY_H

#include "oracle/pair.h"

/* True, and the text, if a guess makes theirs. */
bool oracle_replay(const struct oracle_pair *pair, char text[ORACLE_TEXT]);

/* True if moves are wrong, each judged alone: the text says how many crossings are missed and invented, and the rule
 * for them if there is one, else ORACLE_UNKNOWN (patterns.h). */
bool oracle_judge_moves(const struct oracle_pair *pair, char text[ORACLE_TEXT]);

/* Hits of theirs and ours at all steps, each move judged alone, and how many of them only one has. */
void oracle_count_hits(const struct oracle_pair *pair, uint32_t *hits, uint32_t *wrong);

/* The same where all vertices end as they should: which events are not reported. False if none is missing or invented.
 */
bool oracle_judge_reports(const struct oracle_pair *pair, char text[ORACLE_TEXT]);
/* The same for a drift of the rule `event-driven`. */
bool oracle_replay_events(const struct oracle_pair *pair, char text[ORACLE_TEXT]);

#endif
