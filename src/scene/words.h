/* Suggestions for words that are misspelled. */
#ifndef UNCROSS_SCENE_WORDS_H
#define UNCROSS_SCENE_WORDS_H

#include <stddef.h>

/* The word of `words` (ended by NULL) that is most like this one; NULL if none is near. */
const char *nearest_word(const char *word, const char *const *words);

/* "did you mean 'x'?", or "allowed: " and all words. */
void suggest_word(const char *word, const char *const *words, char *text, size_t size);

#endif
