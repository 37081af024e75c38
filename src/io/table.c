#include "io/table.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/folder.h"

static bool failed(struct message *message, const char *path, const char *what)
{
  return message_set(message, "%s: cannot %s: %s", path, what, strerror(errno));
}

static void write_header(FILE *file, const char *first, size_t columns, const char *const *names)
{
  const char *between = "";
  if (first) {
    fputs(first, file);
    between = ",";
  }
  for (size_t k = 0; k < columns; k++, between = ",")
    fprintf(file, "%s%s", between, names[k]);
  fputc('\n', file);
}

static void write_values(FILE *file, const char *between, size_t columns, const double *values)
{
  for (size_t k = 0; k < columns; k++, between = ",")
    fprintf(file, "%s%.17g", between, values[k]);
  fputc('\n', file);
}

/* Length in bytes of the header and of all whole rows up to and including this step; -1 if they cannot be read. */
static long kept_length(FILE *file, uint64_t keep_to_step)
{
  char *line = NULL;
  size_t room = 0;
  long kept = 0;
  ssize_t length;
  for (bool header = true; (length = getline(&line, &room, file)) > 0; header = false) {
    if (line[length - 1] != '\n' || (!header && strtoull(line, NULL, 10) > keep_to_step))
      break;
    kept += length;
  }
  bool read = length > 0 || feof(file);
  free(line);
  return read ? kept : -1;
}

bool series_open(struct series *s, const char *folder, const char *name, size_t columns, const char *const *names,
                 bool resume, uint64_t keep_to_step, struct message *message)
{
  snprintf(s->path, sizeof s->path, "%s/%s.csv", folder, name);
  s->file = resume ? fopen(s->path, "r+") : NULL;
  if (resume && !s->file && errno != ENOENT)
    return failed(message, s->path, "open");
  if (s->file) {
    long kept = kept_length(s->file, keep_to_step);
    if (kept < 0 || ftruncate(fileno(s->file), kept) != 0 || fseek(s->file, kept, SEEK_SET) != 0)
      return failed(message, s->path, "cut to the checkpoint");
    if (kept > 0)
      return true;
  } else if (!(s->file = fopen(s->path, "w"))) {
    return failed(message, s->path, "create");
  }
  write_header(s->file, "step", columns, names);
  return true;
}

bool series_row(struct series *s, uint64_t step, size_t columns, const double *values, struct message *message)
{
  fprintf(s->file, "%" PRIu64, step);
  write_values(s->file, ",", columns, values);
  return !ferror(s->file) || failed(message, s->path, "write");
}

bool series_flush(struct series *s, struct message *message)
{
  return !s->file || fflush(s->file) == 0 || failed(message, s->path, "write");
}

bool series_close(struct series *s, struct message *message)
{
  FILE *file = s->file;
  s->file = NULL;
  return !file || fclose(file) == 0 || failed(message, s->path, "write");
}

bool table_write(const char *folder, const struct observe_table *table, struct message *message)
{
  char path[4096], *text = NULL;
  size_t bytes;
  snprintf(path, sizeof path, "%s/%s.csv", folder, table->name);
  FILE *file = open_memstream(&text, &bytes);
  if (file) {
    write_header(file, NULL, table->columns, table->column);
    for (size_t r = 0; r < table->rows; r++)
      write_values(file, "", table->columns, &table->value[r * table->columns]);
  }
  bool ok = file && fclose(file) == 0 ? file_replace(path, text, bytes, message) : failed(message, path, "write");
  free(text);
  return ok;
}
