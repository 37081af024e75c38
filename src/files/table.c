#include "files/table.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"

static bool failed(struct message *message, const char *path, const char *what)
{
  return message_unread(message, "%s: cannot %s: %s", path, what, strerror(errno));
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
  char text[TEXT_REAL_SIZE];
  for (size_t k = 0; k < columns; k++, between = ",") {
    text_shortest(values[k] + 0.0, text); /* of two zeros the one without a sign */
    fprintf(file, "%s%s", between, text);
  }
  fputc('\n', file);
}

/* What is kept of a series: so many bytes, and 1 + the step of the last row in them. */
struct kept {
  long bytes;
  uint64_t end;
};

/* True if a line, with its line feed, is the header of these columns. */
static bool is_header(const char *line, size_t length, size_t columns, const char *const *names)
{
  char header[4096];
  size_t at = (size_t)snprintf(header, sizeof header, "step");
  for (size_t k = 0; k < columns && at < sizeof header; k++)
    at += (size_t)snprintf(header + at, sizeof header - at, ",%s", names[k]);
  return length == at + 1 && at < sizeof header && memcmp(line, header, at) == 0;
}

/* A row that was torn by a power failure has zeros in it. */
static bool is_row(const char *line, size_t length, size_t columns)
{
  size_t commas = 0;
  for (size_t k = 0; k + 1 < length; k++) {
    commas += line[k] == ',';
    if (line[k] == '\0' || !strchr("0123456789+-.einfa,", line[k]))
      return false;
  }
  return commas == columns;
}

/* The header and the rows before step `end`, whole lines of increasing steps. False if they cannot be read. */
static bool find_kept(FILE *file, size_t columns, const char *const *names, uint64_t end, struct kept *kept)
{
  char *line = NULL;
  size_t room = 0;
  ssize_t length;
  *kept = (struct kept){0, 0};
  for (bool header = true; (length = text_line(&line, &room, file)) > 0; header = false) {
    char *rest = line;
    const uint64_t step = header ? 0 : strtoull(line, &rest, 10);
    const bool whole = line[length - 1] == '\n' && (header ? is_header(line, (size_t)length, columns, names)
                                                           : is_row(line, (size_t)length, columns));
    if (!whole || (!header && (*rest != ',' || step < kept->end || step >= end)))
      break;
    kept->bytes += length;
    kept->end = header ? 0 : step + 1;
  }
  bool read = length > 0 || length == TEXT_TOO_LONG || feof(file);
  free(line);
  return read;
}

static const char *file_name(const char *table, char name[256])
{
  snprintf(name, 256, "%s.csv", table);
  return name;
}

/* A stream on a file of the folder; NULL, with errno. */
static FILE *open_stream(const struct folder *folder, const char *name, int flags, const char *mode)
{
  const int fd = folder_open_file(folder, name, flags);
  FILE *file = fd < 0 ? NULL : fdopen(fd, mode);
  if (fd >= 0 && !file)
    close(fd);
  return file;
}

/* What stays in a buffer is written once more by every process that forks off this one and ends. */
static bool flushed(const struct series *s)
{
  return fflush(s->file) == 0 && !ferror(s->file);
}

bool series_open(struct series *s, const struct folder *folder, const char *name, size_t columns,
                 const char *const *names, uint64_t end, struct message *message)
{
  struct kept kept;
  char file[256];
  folder_path(folder, file_name(name, file), s->path, sizeof s->path);
  s->file =
      end > 0 ? open_stream(folder, file, O_RDWR, "r+") : open_stream(folder, file, O_WRONLY | O_CREAT | O_EXCL, "w");
  if (!s->file)
    return failed(message, s->path, end > 0 ? "open" : "create");
  if (end == 0)
    write_header(s->file, "step", columns, names);
  else if (!find_kept(s->file, columns, names, end, &kept) || ftruncate(fileno(s->file), kept.bytes) != 0 ||
           fseek(s->file, kept.bytes, SEEK_SET) != 0)
    return failed(message, s->path, "cut to the checkpoint");
  return flushed(s) || failed(message, s->path, "write");
}

bool series_find_end(const struct folder *folder, const char *name, size_t columns, const char *const *names,
                     uint64_t end, uint64_t *found, struct message *message)
{
  char path[4096], table[256];
  struct kept kept = {0, 0};
  folder_path(folder, file_name(name, table), path, sizeof path);
  FILE *file = open_stream(folder, table, O_RDONLY, "r");
  if (!file && errno != ENOENT)
    return failed(message, path, "open");
  bool read = !file || find_kept(file, columns, names, end, &kept) || failed(message, path, "read");
  if (file)
    fclose(file);
  *found = kept.end;
  return read;
}

bool series_row(struct series *s, uint64_t step, size_t columns, const double *values, struct message *message)
{
  fprintf(s->file, "%" PRIu64, step);
  write_values(s->file, ",", columns, values);
  return flushed(s) || failed(message, s->path, "write");
}

bool series_sync(struct series *s, struct message *message)
{
  return !s->file || (flushed(s) && fsync(fileno(s->file)) == 0) || failed(message, s->path, "write");
}

bool series_close(struct series *s, struct message *message)
{
  FILE *file = s->file;
  s->file = NULL;
  return !file || fclose(file) == 0 || failed(message, s->path, "write");
}

bool table_write(const struct folder *folder, const struct observe_table *table, struct message *message)
{
  char path[4096], name[256], *text = NULL;
  size_t bytes;
  folder_path(folder, file_name(table->name, name), path, sizeof path);
  FILE *file = open_memstream(&text, &bytes);
  if (file) {
    write_header(file, NULL, table->columns, table->column);
    for (size_t r = 0; r < table->rows; r++)
      write_values(file, "", table->columns, &table->value[r * table->columns]);
  }
  bool ok =
      file && fclose(file) == 0 ? file_replace(folder, name, text, bytes, message) : failed(message, path, "write");
  free(text);
  return ok;
}

/* Lines of a file, and whether the first one is this header. False if it cannot be read to its end. */
static bool count_lines(FILE *file, const char *header, bool *same, size_t *lines)
{
  char *line = NULL;
  size_t room = 0;
  ssize_t length;
  for (*same = false, *lines = 0; (length = text_line(&line, &room, file)) > 0; ++*lines)
    *same = *lines == 0 ? strcmp(line, header) == 0 : *same;
  free(line);
  *lines += length == TEXT_TOO_LONG;
  return length == TEXT_TOO_LONG || feof(file);
}

bool table_fits(const struct folder *folder, const struct observe_table *table, struct message *message)
{
  char path[4096], name[256], *header = NULL;
  size_t bytes, lines = 0;
  bool same = false;
  folder_path(folder, file_name(table->name, name), path, sizeof path);
  FILE *made = open_memstream(&header, &bytes), *file = open_stream(folder, name, O_RDONLY, "r");
  if (made)
    write_header(made, NULL, table->columns, table->column);
  const bool known = made && fclose(made) == 0 && file && count_lines(file, header, &same, &lines);
  if (file)
    fclose(file);
  free(header);
  if (!known)
    return failed(message, path, "read");
  return (same && lines == table->rows + 1) ||
         message_set(message, "%s: damaged: %s; the checkpoint makes %zu rows of %zu columns", path,
                     same ? "it has another number of rows" : "its first line is another", table->rows, table->columns);
}

size_t table_columns(const char *line)
{
  size_t columns = 1;
  for (; *line; line++)
    columns += *line == ',';
  return columns;
}
