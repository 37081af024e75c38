#include "oracle/contract.h"

#include <string.h>

#include "contact/rule.h"
#include "files/start.h"

bool contract_covers(const struct scene *scene, bool packs, struct message *message)
{
  const struct model *m = &scene->model;
  const bool bead = model_has_bead(m), flow = model_has_walls(m) || model_is_sheared(m);
  const struct {
    bool is;
    const char *what;
  } outside[] = {
      {model_has_phantoms(m), "solvent.bath: it is phantoms"},
      {m->dimensions != 3, "dimensions: they are 2"},
      {m->solvent.profile != PROFILE_UNIFORM, "solvent.profile: it is not uniform"},
      {model_has_walls(m) && m->solvent.rule != RULE_SRD, "solvent.rule: it is not srd, between walls"},
      {flow && m->kinds > 0, "fibers: there are some, in walls or shear"},
      {bead && (!packs || m->kinds == 0), "bead: there is one, and packs have its contacts with fibers only"},
      {m->crossing.rejection != REJECTION_STAY || m->crossing.frame != FRAME_LABORATORY,
       "crossing.refusal or crossing.frame: not the paper's"},
      {m->medium.inextensible, "medium.inextensible: it is true"},
      {m->held > 0, "fibers.frozen or fibers.held: vertices are held"},
  };
  for (size_t k = 0; k < sizeof outside / sizeof *outside; k++)
    if (outside[k].is)
      return message_set(message, "%s: %s; such a scene is outside of the contract (docs/port/formats.md)", scene->path,
                         outside[k].what);
  return true;
}

/* Ports know where images are by the time, which begins at 0. */
bool contract_start(struct scene *scene, struct state *state, struct work *work, struct message *message)
{
  struct stream stream;
  return scene_start(scene, state, work, &stream, message) &&
         (scene->model.shear.slid == 0 ||
          message_set(message,
                      "%s: start.snapshot: the images of its sheared box have slid; packs and traces begin without a "
                      "slide; allowed: a snapshot of a box at rest, or none",
                      scene->path));
}
