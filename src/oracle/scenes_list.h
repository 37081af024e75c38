/*
 * Scenes that have an operator, or a table of it: one row each. The list is included with another SCENES each time, for
 * names, words and conditions, and has no guard.
 *
 *   SCENES(name, words, condition)
 *
 * condition: of the model m, and of what scenes.c calls it in short.
 */
#ifndef SCENES
#define SCENES(name, words, condition) /* a tool that reads this file alone */
#endif

SCENES(OF_ALL, "all", true)
SCENES(OF_NO_STEP, "none: it is no operator of a step", false)
SCENES(OF_FIBERS, "a periodic box", periodic)
SCENES(OF_MOVING, "a periodic box, vertices with velocities", periodic &&moving)
SCENES(OF_TURNS, "a periodic box, vertices that move one by one", periodic &&moving && !oracle_has_events(m))
SCENES(OF_EVENTS, "the rule event-driven", events)
SCENES(OF_TUBES, "the rule event-driven, thick fibers", events &&thick)
SCENES(OF_THICK, "thick fibers", thick)
SCENES(OF_COMPANY, "fibers around a bead", company)

SCENES(OF_SOLVENT, "a solvent", solvent)
SCENES(OF_PERIODIC_POINTS, "a solvent without dumbbells, a periodic box", solvent &&periodic && !dumbbells)
SCENES(OF_CELLS, "a solvent, no walls", solvent && !walls)
SCENES(OF_SRD, "the rule srd", solvent &&srd)
SCENES(OF_ANDERSENS, "the rules at-a and at+a", solvent && !srd)
SCENES(OF_ANDERSEN, "the rule at-a", solvent && m->solvent.rule == RULE_AT_A)
SCENES(OF_SPIN, "the rule at+a", solvent && m->solvent.rule == RULE_AT_PLUS_A)
SCENES(OF_OTHER_RULE, "another rule than srd", !srd)
SCENES(OF_HOMOGENEOUS, "the rule srd, a periodic box", solvent &&periodic &&srd)
SCENES(OF_LAYERS, "the rule srd, walls or shear", solvent && !periodic && srd)

SCENES(OF_FLOW, "walls or shear", !periodic)
SCENES(OF_BETWEEN_WALLS, "walls", walls)
SCENES(OF_OSCILLATION, "walls or shear that oscillate", !periodic && m->wave.intervals > 0)
SCENES(OF_WALLS, "a solvent between walls", solvent &&walls)
SCENES(OF_WALL_POINTS, "a solvent without dumbbells between walls", solvent &&walls && !dumbbells)
SCENES(OF_SHEAR, "a sheared solvent", solvent &&shear)
SCENES(OF_SHEAR_POINTS, "a sheared solvent without dumbbells", solvent &&shear && !dumbbells)
SCENES(OF_WAVE, "a solvent in oscillating shear", solvent &&shear && m->wave.intervals > 0)

SCENES(OF_DUMBBELLS, "dumbbells", dumbbells)
SCENES(OF_PERIODIC_DUMBBELLS, "dumbbells in a periodic box", dumbbells &&periodic)
SCENES(OF_WALL_DUMBBELLS, "dumbbells between walls", dumbbells &&walls)
SCENES(OF_SHEAR_DUMBBELLS, "sheared dumbbells", dumbbells &&shear)

SCENES(OF_MEDIUM, "a medium other than the solvent", !model_in_cells(m))
SCENES(OF_PRIVATE, "a private bath", m->medium.kind == MEDIUM_PRIVATE)
SCENES(OF_PAIRS, "a bath of pairs", pairs)
SCENES(OF_STREAM, "particles without dumbbells, a periodic box", (solvent && periodic && !dumbbells) || pairs)
SCENES(OF_REPULSION, "forces of pairs", model_repels(m))
SCENES(OF_CROWD, "forces of many bodies", m->medium.many.repulsion != 0.0)
SCENES(OF_OVERDAMPED, "overdamped motion", !moving)
SCENES(OF_TENSOR, "overdamped motion with a tensor", !moving && m->medium.tensor != TENSOR_NONE)
