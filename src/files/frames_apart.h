/* What the two sides of frames.h say to each other. */
#ifndef UNCROSS_FILES_FRAMES_APART_H
#define UNCROSS_FILES_FRAMES_APART_H

#include <stdbool.h>
#include <stdint.h>

#include "files/apart.h"

/* After the verdict about the file (enum h5_trouble), struct frames_about, the structure and the scene follow. Then
 * requests are answered until the link is cut: a verdict, the moment if it is FRAME_FINE or FRAME_DAMAGED, and if it is
 * fine and they are asked for, positions and velocities. */
struct frame_request {
  uint64_t frame;
  uint64_t rows; /* 1: positions and velocities are wanted too; as wide as frame, so that no unset byte is sent */
};

struct frame_moment {
  uint64_t step;
  double time;
  bool has_box;
  double edge[3];
};

/* The work of the process apart, "frames". */
void frames_serve(struct apart *link);

/* The same for h5_find_sort, "sort": a verdict, and enum h5_sort. */
void sort_serve(struct apart *link);

#endif
