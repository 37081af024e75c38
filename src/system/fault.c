#include "system/fault.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

static const char momentum_beyond[] = "has a momentum beyond the range of its cell's sums:",
                  energy_beyond[] =
                      "moves in its cell with a mass times velocity squared beyond the range of their sum:";

static const struct {
  const char *entity, *what, *unit;
  bool heated; /* it happens where something has become too hot */
  enum {
    MOST,
    LEAST,
    FROM_0
  } limit; /* it is the largest value allowed, the least, or the largest of those from 0 on */
} wording[] = {
    [FAULT_NONE] = {"", "nothing wrong", "", false, MOST},
    [FAULT_SOLVENT_MOVE] = {"solvent particle", "moves too far in one collision interval:", "a0", true, MOST},
    [FAULT_SOLVENT_SPEED] = {"solvent particle", momentum_beyond, "m a0/t0", true, MOST},
    [FAULT_VERTEX_SPEED] = {"vertex", momentum_beyond, "m a0/t0", true, MOST},
    [FAULT_SOLVENT_ENERGY] = {"solvent particle", energy_beyond, "m a0^2/t0^2", true, MOST},
    [FAULT_VERTEX_ENERGY] = {"vertex", energy_beyond, "m a0^2/t0^2", true, MOST},
    [FAULT_CELL_MASS] = {"collision cell", "holds more mass than its sum can:", "m", true, MOST},
    [FAULT_VERTEX_MOVE] = {"vertex", "moves too far in one time step:", "a0", true, MOST},
    [FAULT_VERTEX_PLACE] = {"vertex", "is too far from the origin, unwrapped:", "a0", false, MOST},
    [FAULT_SOLVENT_PLACE] = {"solvent particle", "is not in the box:", "a0", false, FROM_0},
    [FAULT_VERTEX_WALL] = {"vertex", "is beyond a wall, at y =", "a0", false, FROM_0},
    [FAULT_DUMBBELL] = {"dumbbell", "has a spring that is too long, or does not fit its two particles:", "a0", false,
                        MOST},
    [FAULT_BEAD_MOVE] = {"bead", "and the solvent near it reach too far in one collision interval:", "a0", true, MOST},
    [FAULT_BEAD_WALL] = {"bead", "is in a wall: its center is from it by", "a0", false, LEAST},
    [FAULT_IN_BEAD] = {"solvent particle", "is inside the bead, at a distance from its center of", "a0", false, LEAST},
    [FAULT_BOND_TOO_LONG] = {"bond", "is longer than half the shortest box edge:", "a0", true, MOST},
    [FAULT_OVERLAP] = {"bond", "overlaps with another one: their axes are apart by", "a0", false, LEAST},
    [FAULT_BEAD_OVERLAP] = {"bond", "overlaps with the bead: its axis is from the center by", "a0", false, LEAST},
    [FAULT_GIVEN_UP] = {"fiber", "was being laid when the start was given up:", "", false, MOST},
    [FAULT_NO_ROOM] = {"fiber", "overlaps with others wherever it is laid:", "attempts", false, MOST},
    [FAULT_MOBILITY] =
        {"the fiber of vertex",
         "has places where its tensor (oseen) is not positive, so that no noise belongs to it; a pivot is", "D0", false,
         LEAST},
    [FAULT_TENSION] =
        {"the fiber of vertex",
         "has bonds whose tensions cannot be found: a bond has no length, or the tensor is not positive; a "
         "pivot of their matrix is",
         "D0", false, LEAST},
    [FAULT_NO_MEMORY] = {"", "", "", false, MOST},
};

void fault_describe(const struct fault *fault, char *text, size_t size)
{
  if (fault->code == FAULT_NO_MEMORY) {
    snprintf(text, size, "step %" PRIu64 ": memory is short for the lists of bonds that may touch", fault->step);
    return;
  }
  static const char *const bounds[] = {[MOST] = "at most", [LEAST] = "at least", [FROM_0] = "0 to"};
  const char *hint =
      !wording[fault->code].heated ? "" : " (a time step that is too large, or a heated system, is the usual cause)";
  char value[TEXT_REAL_SIZE], limit[TEXT_REAL_SIZE];
  snprintf(value, sizeof value, "%.8g", text_real(fault->value));
  snprintf(limit, sizeof limit, "%.8g", fault->limit);
  if (strcmp(value, limit) == 0) /* it is beyond by a hair */
    text_shortest(fault->value, value);
  snprintf(text, size, "step %" PRIu64 ": %s %" PRId64 " %s %s %s; %s %s is allowed%s", fault->step,
           wording[fault->code].entity, fault->entity, wording[fault->code].what, value, wording[fault->code].unit,
           bounds[wording[fault->code].limit], limit, hint);
}

int message_fault(struct message *message, const struct fault *fault)
{
  char text[sizeof message->text];
  fault_describe(fault, text, sizeof text);
  return message_set(message, "%s", text);
}

bool fault_record(struct fault *fault, enum fault_code code, uint64_t step, int64_t entity, double value, double limit)
{
  if (fault->code == FAULT_NONE)
    *fault = (struct fault){code, step, entity, value, limit};
  return false;
}

bool fault_no_memory(struct fault *fault, uint64_t step)
{
  return fault_record(fault, FAULT_NO_MEMORY, step, 0, 0.0, 0.0);
}
