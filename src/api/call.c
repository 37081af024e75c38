/* What every call does: errors as values, the C locale for this thread, no words of HDF5. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/handle.h"
#include "version.h"

static const int causes[] = {
    [FAULT_NONE] = UNCROSS_CAUSE_NONE,
    [FAULT_SOLVENT_MOVE] = UNCROSS_CAUSE_SOLVENT_MOVE,
    [FAULT_SOLVENT_SPEED] = UNCROSS_CAUSE_SOLVENT_SPEED,
    [FAULT_VERTEX_SPEED] = UNCROSS_CAUSE_VERTEX_SPEED,
    [FAULT_SOLVENT_ENERGY] = UNCROSS_CAUSE_SOLVENT_ENERGY,
    [FAULT_VERTEX_ENERGY] = UNCROSS_CAUSE_VERTEX_ENERGY,
    [FAULT_CELL_MASS] = UNCROSS_CAUSE_CELL_MASS,
    [FAULT_VERTEX_MOVE] = UNCROSS_CAUSE_VERTEX_MOVE,
    [FAULT_VERTEX_PLACE] = UNCROSS_CAUSE_VERTEX_PLACE,
    [FAULT_BOND_TOO_LONG] = UNCROSS_CAUSE_BOND_TOO_LONG,
    [FAULT_NO_MEMORY] = UNCROSS_CAUSE_NO_MEMORY,
};

static int cause_of(enum fault_code code)
{
  const size_t k = (size_t)code;
  if (code == FAULT_NONE)
    return UNCROSS_CAUSE_NONE;
  return k < sizeof causes / sizeof *causes && causes[k] ? causes[k] : UNCROSS_CAUSE_OTHER;
}

int fail(uncross_error *error, int code, const char *message, const struct fault *fault)
{
  if (!error)
    return code;
  memset(error, 0, sizeof *error);
  error->code = code;
  if (fault && fault->code != FAULT_NONE) {
    error->cause = cause_of(fault->code);
    error->step = fault->step;
    error->entity = fault->entity;
    error->value = fault->value;
    error->limit = fault->limit;
  }
  snprintf(error->message, sizeof error->message, "%s", message);
  return code;
}

int fail_steps(uncross_error *error, uint64_t most)
{
  char text[128];
  snprintf(text, sizeof text, "steps: too many; allowed: 0 .. %" PRIu64, most);
  return fail(error, UNCROSS_BAD_INPUT, text, NULL);
}

int fail_null(uncross_error *error, const char *what)
{
  char text[128];
  snprintf(text, sizeof text, "%s is NULL", what);
  return fail(error, UNCROSS_BAD_INPUT, text, NULL);
}

/* A program may speak a language in which 0.5 is 0,5. uselocale is for this thread only. */
void call_begin(struct call *call, bool files)
{
  *call = (struct call){.files = files};
  call->ours = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  if (call->ours)
    call->theirs = uselocale(call->ours);
  if (files) {
    H5Eget_auto2(H5E_DEFAULT, &call->print, &call->print_data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  }
}

void call_end(struct call *call)
{
  if (call->files)
    H5Eset_auto2(H5E_DEFAULT, call->print, call->print_data);
  if (call->ours) {
    uselocale(call->theirs);
    freelocale(call->ours);
  }
}

const char *uncross_version(void)
{
  return UNCROSS_VERSION;
}

int uncross_interface(void)
{
  return UNCROSS_INTERFACE;
}

int uncross_interface_age(void)
{
  return UNCROSS_INTERFACE_AGE;
}

void uncross_free(void *memory)
{
  free(memory);
}
