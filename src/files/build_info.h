/* How this program was built; the Makefile fills it in. */
#ifndef UNCROSS_FILES_BUILD_INFO_H
#define UNCROSS_FILES_BUILD_INFO_H

struct build_info {
  const char *commit;   /* git commit, "-dirty" appended if the tree had changes; "unknown" outside a checkout */
  const char *compiler; /* name and version */
  const char *flags;
  const char *prefix; /* where `make install` puts it */
};

extern const struct build_info build_info;

#endif
