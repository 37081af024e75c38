/* The part of a model that model_finish derives vertex by vertex: fibers, bonds, masses. */
#ifndef UNCROSS_SYSTEM_TOPOLOGY_H
#define UNCROSS_SYSTEM_TOPOLOGY_H

#include "system/model.h"

/* Counts fibers, vertices and bonds, and sums masses. */
void model_count(struct model *model);

/* Numbers fibers and vertices, and allocates and fills bonds and masses. False if memory is short. */
bool model_lay(struct model *model);

#endif
