/* Text for people: foreign text that cannot act on a terminal, and numbers without a sign that means nothing. */
#ifndef UNCROSS_BASE_TEXT_H
#define UNCROSS_BASE_TEXT_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/types.h>

/* The number of the character at the beginning of a text, and its bytes; 0 bytes if they are no UTF-8. */
size_t text_character(const char *text, uint32_t *code);

/* True for characters that act on a terminal instead of being shown: control characters, line ends of Unicode (U+2028,
 * U+2029), marks and directions of writing (U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069), U+FEFF. */
bool text_acts(uint32_t code);

/* Copies text from anywhere (a file, a scene, a name) so that a terminal only shows it: the bytes of characters that
 * act, and bytes that are no UTF-8 (The Unicode Standard 15.0, table 3-7), become \xNN; line feeds and tabs become \n
 * and \t. All else comes out as it is. Cut to `size` bytes with the '\0' at the end, never within a character. Returns
 * `to`. */
const char *text_escape(const char *text, char *to, size_t size);

/* The same, in memory of the enclosing block. */
#define text_shown(text) text_escape((text), (char[1024]){""}, 1024)

/* Prints the same, whole: for comments too, which end with the line. */
void text_print(FILE *file, const char *text);

/* Prints a word as bash takes it, which a terminal only shows. Another shell may take it for another word, but never
 * for more than one. */
void text_print_word(FILE *file, const char *word);

#define TEXT_LONGEST_LINE 65535 /* bytes with the end; no file of ours has one of a tenth of this */
#define TEXT_TOO_LONG (-2)      /* what text_line returns then */

/* As getline of POSIX, but a longer line is not read whole: files of others may have no end of a line at all. */
ssize_t text_line(char **line, size_t *room, FILE *in);

/* The number, but NaN never with a sign: printf would show -nan, on some machines and not on others. */
static inline double text_real(double x)
{
  return isnan(x) ? fabs(x) : x;
}

enum { TEXT_REAL_SIZE = 32 };

/* The number in the fewest digits that read back to it (%.15g, %.16g or %.17g). */
void text_shortest(double x, char text[TEXT_REAL_SIZE]);

/* So many of them, with spaces between. */
void text_print_reals(FILE *file, size_t count, const double *x);

#endif
