/* Whether files are of one run: what a resumed run keeps, whoever says otherwise. */
#ifndef UNCROSS_FILES_SAME_RUN_H
#define UNCROSS_FILES_SAME_RUN_H

#include "files/frames.h"
#include "files/snapshot.h"
#include "scene/scene.h"

/* Fingerprint and seed must be those of the checkpoint. A scene may say the seed that the run's own scene says,
 * although the run was begun with another one (--seed). then: the run's own scene, NULL if not known. seed: set from
 * outside, or NULL. False, with a message that names the key. */
bool same_run(const struct scene *scene, const struct checkpoint_head *head, const struct scene *then,
              const uint64_t *seed, const char *path, struct message *message);

enum same_run { SAME_RUN, OTHER_RUN, SAME_RUN_UNKNOWN };

/* The same of a file. To be asked before the checkpoint is read as one of the scene: a message about a key says more
 * than one about numbers. With a message that names the key, or says why the file cannot be compared. */
enum same_run same_run_as_begun(const struct scene *scene, const char *path, const uint64_t *seed,
                                struct message *message);

/* Whether frames are of this run, as far as their file tells: seed, stream, slide, scene, and particles. scene in the
 * options: by its fingerprint. False, with a message that names what differs. */
bool same_run_frames(const struct frames *frames, const struct model *model, const struct trajectory_options *options,
                     struct message *message);

/* The same of a trajectory's file; true if it cannot be read. */
bool same_run_trajectory(const char *path, const struct model *model, const struct trajectory_options *options,
                         struct message *message);

#endif
