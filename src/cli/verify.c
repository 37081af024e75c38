/* `uncross verify`: files and folders, one after the other. */
#include <sys/stat.h>

#include "base/text.h"
#include "cli/command.h"
#include "files/seal.h"
#include "files/verify.h"
#include "oracle/pack.h"

static enum condition verify_pack(const char *path)
{
  struct message message, ignored;
  struct pack pack;
  if (!pack_read(path, &pack, &message)) {
    const bool known = pack_begins(path);
    printf("%s%s\n", message.text,
           known
               ? ""
               : "; not a file that verify knows: checkpoints and trajectories (.h5), tables (.csv), run.json, packs");
    return known ? CONDITION_DAMAGED : CONDITION_UNKNOWN;
  }
  if (seal_check(path, &ignored) == SEAL_FITS)
    printf("%s: whole: a pack of %zu tables, every byte fits its seal\n", text_shown(path), pack.count);
  else
    printf("%s: readable: a pack of %zu tables; it carries no checksum of the whole\n", text_shown(path), pack.count);
  pack_free(&pack);
  return CONDITION_WHOLE;
}

static enum condition verify(const char *path)
{
  struct stat status;
  bool other;
  if (stat(path, &status) == 0 && S_ISDIR(status.st_mode))
    return verify_folder(path, stdout);
  const enum condition condition = verify_file(path, &other, stdout);
  return other ? verify_pack(path) : condition;
}

enum exit_code command_verify(const struct arguments *a)
{
  static const enum exit_code codes[] = {
      [CONDITION_WHOLE] = EXIT_DONE, [CONDITION_UNKNOWN] = EXIT_BAD_INPUT, [CONDITION_DAMAGED] = EXIT_DAMAGED};
  enum condition worst = CONDITION_WHOLE;
  for (size_t k = 0; k < a->files; k++) {
    const enum condition found = verify(a->all_files[k]);
    worst = found > worst ? found : worst;
  }
  return codes[worst];
}
