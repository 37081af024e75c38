/* The tables of docs/scene.md, from the tables of keys; and that of docs/observables.md. */
#include <stdio.h>

#include "observe/meaning.h"
#include "scene/scene_keys.h"

/* In a cell of a table a bar would end the cell. */
static void write_cell(FILE *f, const char *text)
{
  for (const char *c = text; *c; c++)
    fprintf(f, "%s%c", *c == '|' ? "\\" : "", *c);
}

static void write_row(FILE *f, const struct key *key)
{
  char allowed[512];
  key_describe(key, allowed, sizeof allowed);
  const char *fallback = key->fallback ? key->fallback : key->absent, *quote = fallback ? "`" : "";
  fprintf(f, "| `%s` | ", key->name);
  write_cell(f, allowed);
  fprintf(f, " | %s%s%s | %s | %s | ", quote,
          fallback        ? fallback
          : key->optional ? "none"
          : key->idle     ? "required for bonds"
                          : "required",
          quote, key->unit ? key->unit : "", key->symbol ? key->symbol : "");
  write_cell(f, key->text);
  fputs(" |\n", f);
}

static void write_rows(FILE *f, const struct key_table *table)
{
  for (size_t k = 0; k < table->count; k++)
    if (table->key[k].type == KEY_INCLUDE)
      write_rows(f, table->key[k].keys);
    else
      write_row(f, &table->key[k]);
}

static void document_table(FILE *f, const struct key_table *table)
{
  const char *name = *table->path ? table->path : "Top level";
  fprintf(f, "<!-- keys: %s -->\n## %s\n\n%s%s", name, name, table->text ? table->text : "", table->text ? "\n\n" : "");
  fputs("| key | allowed | default | unit | symbol | meaning |\n| --- | --- | --- | --- | --- | --- |\n", f);
  write_rows(f, table);
  fputs("\n<!-- end of keys -->\n", f);
}

/* The tables of sections, each before those that are within it. */
static void document_sections(FILE *f, const struct key_table *table)
{
  for (size_t k = 0; k < table->count; k++) {
    const struct key *key = &table->key[k];
    if (key->type == KEY_SECTION || key->type == KEY_LIST)
      document_table(f, key->keys);
    if (key->keys)
      document_sections(f, key->keys);
  }
}

void scene_document(FILE *f)
{
  document_table(f, &scene_keys);
  document_sections(f, &scene_keys);
  meaning_document(f);
}
