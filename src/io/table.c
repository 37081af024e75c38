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

/* What is kept of a series: so many bytes, and 1 + the step of the last row in them. */
struct kept {
  long bytes;
  uint64_t end;
};

/* The header and the rows before step `end`, whole lines of increasing steps. False if they cannot be read. */
static bool find_kept(FILE *file, uint64_t end, struct kept *kept)
{
  char *line = NULL;
  size_t room = 0;
  ssize_t length;
  *kept = (struct kept){0, 0};
  for (bool header = true; (length = getline(&line, &room, file)) > 0; header = false) {
    char *rest = line;
    const uint64_t step = header ? 0 : strtoull(line, &rest, 10);
    if (line[length - 1] != '\n' || (!header && (*rest != ',' || step < kept->end || step >= end)))
      break;
    kept->bytes += length;
    kept->end = header ? 0 : step + 1;
  }
  bool read = length > 0 || feof(file);
  free(line);
  return read;
}

static void set_path(char path[4096], const char *folder, const char *name)
{
  snprintf(path, 4096, "%s/%s.csv", folder, name);
}

bool series_open(struct series *s, const char *folder, const char *name, size_t columns, const char *const *names,
                 uint64_t end, struct message *message)
{
  struct kept kept;
  set_path(s->path, folder, name);
  s->file = fopen(s->path, end > 0 ? "r+" : "wx");
  if (!s->file)
    return failed(message, s->path, end > 0 ? "open" : "create");
  if (end == 0)
    write_header(s->file, "step", columns, names);
  else if (!find_kept(s->file, end, &kept) || ftruncate(fileno(s->file), kept.bytes) != 0 ||
           fseek(s->file, kept.bytes, SEEK_SET) != 0)
    return failed(message, s->path, "cut to the checkpoint");
  return true;
}

bool series_find_end(const char *folder, const char *name, uint64_t end, uint64_t *found, struct message *message)
{
  char path[4096];
  struct kept kept = {0, 0};
  set_path(path, folder, name);
  FILE *file = fopen(path, "r");
  if (!file && errno != ENOENT)
    return failed(message, path, "open");
  bool read = !file || find_kept(file, end, &kept) || failed(message, path, "read");
  if (file)
    fclose(file);
  *found = kept.end;
  return read;
}

bool series_row(struct series *s, uint64_t step, size_t columns, const double *values, struct message *message)
{
  fprintf(s->file, "%" PRIu64, step);
  write_values(s->file, ",", columns, values);
  return !ferror(s->file) || failed(message, s->path, "write");
}

bool series_sync(struct series *s, struct message *message)
{
  return !s->file || (fflush(s->file) == 0 && fsync(fileno(s->file)) == 0) || failed(message, s->path, "write");
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
  set_path(path, folder, table->name);
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
