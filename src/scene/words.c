#include "scene/words.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { WORD_MAX = 40 };

static size_t least_of(size_t a, size_t b, size_t c)
{
  size_t m = a < b ? a : b;
  return m < c ? m : c;
}

/* How many letters must be changed, put in or left out, or neighbors exchanged, to get from a to b (Damerau 1964,
 * "optimal string alignment"). Both shorter than WORD_MAX. */
static size_t edit_distance(const char *a, const char *b)
{
  size_t d[WORD_MAX + 1][WORD_MAX + 1];
  const size_t n = strlen(a), m = strlen(b);
  for (size_t i = 0; i <= n; i++)
    d[i][0] = i;
  for (size_t j = 0; j <= m; j++)
    d[0][j] = j;
  for (size_t i = 1; i <= n; i++)
    for (size_t j = 1; j <= m; j++) {
      size_t change = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      d[i][j] = least_of(change, d[i - 1][j] + 1, d[i][j - 1] + 1);
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && d[i - 2][j - 2] + 1 < d[i][j])
        d[i][j] = d[i - 2][j - 2] + 1;
    }
  return d[n][m];
}

const char *nearest_word(const char *word, const char *const *words)
{
  const size_t length = strlen(word);
  const char *nearest = NULL;
  size_t best = length / 2 + 1; /* half the letters must be right */
  for (; length < WORD_MAX && *words; words++) {
    bool begins = length >= 3 && strncmp(word, *words, length) == 0;
    size_t distance = begins ? 1 : strlen(*words) < WORD_MAX ? edit_distance(word, *words) : best;
    if (distance < best) {
      best = distance;
      nearest = *words;
    }
  }
  return nearest;
}

void suggest_word(const char *word, const char *const *words, char *text, size_t size)
{
  const char *nearest = nearest_word(word, words);
  if (nearest) {
    snprintf(text, size, "did you mean '%s'?", nearest);
    return;
  }
  size_t used = (size_t)snprintf(text, size, "allowed:");
  for (; *words && used < size; words++)
    used += (size_t)snprintf(text + used, size - used, " %s", *words);
}
