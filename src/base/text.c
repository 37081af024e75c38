#include "base/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t text_character(const char *text, uint32_t *code)
{
  const unsigned char *byte = (const unsigned char *)text;
  static const struct {
    unsigned char low, high, mask;
    uint32_t least; /* number: shorter forms are not allowed */
  } forms[] = {{0x01, 0x7f, 0x7f, 0}, {0xc2, 0xdf, 0x1f, 0x80}, {0xe0, 0xef, 0x0f, 0x800}, {0xf0, 0xf4, 0x07, 0x10000}};
  size_t bytes = 0;
  while (bytes < 4 && !(byte[0] >= forms[bytes].low && byte[0] <= forms[bytes].high))
    bytes++;
  if (bytes == 4)
    return 0;
  *code = byte[0] & forms[bytes].mask;
  for (size_t k = 1; k <= bytes; k++) {
    if ((byte[k] & 0xc0) != 0x80) /* '\0' is none either */
      return 0;
    *code = *code << 6 | (byte[k] & 0x3fu);
  }
  const bool surrogate = *code >= 0xd800 && *code <= 0xdfff;
  return *code < forms[bytes].least || *code > 0x10ffff || surrogate ? 0 : bytes + 1;
}

bool text_acts(uint32_t code)
{
  static const uint32_t ranges[][2] = {{0x00, 0x1f},     {0x7f, 0x9f},     {0x200e, 0x200f},
                                       {0x2028, 0x202e}, {0x2066, 0x2069}, {0xfeff, 0xfeff}};
  for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++)
    if (code >= ranges[k][0] && code <= ranges[k][1])
      return true;
  return false;
}

/* One character as it is shown, and the bytes that it takes. */
static size_t show(const char *text, char shown[17])
{
  uint32_t code = 0;
  const size_t bytes = text_character(text, &code), taken = bytes > 0 ? bytes : 1;
  if (bytes > 0 && !text_acts(code)) {
    memcpy(shown, text, bytes);
    shown[bytes] = '\0';
  } else if (code == '\n' || code == '\t') {
    snprintf(shown, 17, "\\%c", code == '\n' ? 'n' : 't');
  } else {
    for (size_t k = 0; k < taken; k++)
      snprintf(shown + 4 * k, 5, "\\x%02x", (unsigned char)text[k]);
  }
  return taken;
}

const char *text_escape(const char *text, char *to, size_t size)
{
  size_t at = 0;
  while (*text) {
    char shown[17];
    text += show(text, shown);
    const size_t length = strlen(shown);
    if (at + length >= size)
      break;
    memcpy(to + at, shown, length);
    at += length;
  }
  to[at] = '\0';
  return to;
}

void text_shortest(double x, char text[TEXT_REAL_SIZE])
{
  int digits = 15;
  do
    snprintf(text, TEXT_REAL_SIZE, "%.*g", digits, text_real(x));
  while (digits++ < 17 && strtod(text, NULL) != x && !isnan(x));
}

void text_print_reals(FILE *file, size_t count, const double *x)
{
  char text[TEXT_REAL_SIZE];
  for (size_t k = 0; k < count; k++) {
    text_shortest(x[k], text);
    fprintf(file, "%s%s", k > 0 ? " " : "", text);
  }
}

void text_print(FILE *file, const char *text)
{
  while (*text) {
    char shown[17];
    text += show(text, shown);
    fputs(shown, file);
  }
}

static bool acts_somewhere(const char *text)
{
  bool acts = false;
  while (*text && !acts) {
    uint32_t code = 0;
    const size_t bytes = text_character(text, &code);
    acts = bytes == 0 || text_acts(code);
    text += bytes;
  }
  return acts;
}

/* Within $'...' each byte that is not ASCII, or acts, is \xNN. So is the quote: shells that do not know $ before a
 * quote take a backslash for itself, and would end the word at \'. */
static void print_bytes(FILE *file, const char *text)
{
  for (; *text; text++) {
    const unsigned char c = (unsigned char)*text;
    if (c < 0x20 || c > 0x7e || c == '\'')
      fprintf(file, "\\x%02x", c);
    else
      fprintf(file, "%s%c", c == '\\' ? "\\" : "", c);
  }
}

void text_print_word(FILE *file, const char *word)
{
  static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=:,+-";
  if (*word && word[strspn(word, plain)] == '\0') {
    fputs(word, file);
    return;
  }
  const bool acts = acts_somewhere(word);
  fputs(acts ? "$'" : "'", file);
  if (acts)
    print_bytes(file, word);
  for (const char *c = word; !acts && *c; c++)
    if (*c == '\'')
      fputs("'\\''", file);
    else
      fputc(*c, file);
  fputc('\'', file);
}

ssize_t text_line(char **line, size_t *room, FILE *in)
{
  size_t length = 0;
  int c = 0;
  if (*room <= TEXT_LONGEST_LINE) {
    char *whole = realloc(*line, TEXT_LONGEST_LINE + 1);
    if (!whole)
      return -1;
    *line = whole;
    *room = TEXT_LONGEST_LINE + 1;
  }
  while (c != '\n' && (c = getc_unlocked(in)) != EOF) {
    if (length == TEXT_LONGEST_LINE)
      return TEXT_TOO_LONG;
    (*line)[length++] = (char)c;
  }
  (*line)[length] = '\0';
  return length > 0 && !ferror(in) ? (ssize_t)length : -1;
}
