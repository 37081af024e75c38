/* Names that other codes give to what a key of a scene means. */
#ifndef UNCROSS_SCENE_SYNONYMS_H
#define UNCROSS_SCENE_SYNONYMS_H

/* What to say to whoever writes `name`: "did you mean 'time_step'?"; NULL if nothing is known. */
const char *synonym_hint(const char *name);

#endif
