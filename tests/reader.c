/* Linked into every program that is linked with all rooms and is not uncross itself: so it is its own reader
 * (src/files/reader.h), with the bugs that are planted in it and the failures that are asked of it. */
#include "files/reader.h"
#include "files/checkpoint.h"
#include "files/frames_apart.h"
#include "oracle/pack.h"

extern const struct apart_work test_works[] __attribute__((weak)); /* those of a test, instead */

__attribute__((constructor)) static void begin(int count, char **words)
{
  static const struct apart_work works[] = {{"checkpoint", checkpoint_serve},
                                            {"frames", frames_serve},
                                            {"sort", sort_serve},
                                            {"pack", pack_serve},
                                            {NULL, NULL}};
  reader_is_here(count, words, test_works ? test_works : works);
}
