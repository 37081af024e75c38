/* The tables of docs/scene.md, from the tables of keys and of refusals; and that of docs/observables.md. */
#include <stdio.h>
#include <string.h>

#include "observe/meaning.h"
#include "scene/scene_keys.h"
#include "system/refusals.h"

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

/* The key that follows this one in the alphabet, of those that are refused; NULL after the last. */
static const char *next_refused(const char *key)
{
  const char *next = NULL;
  for (size_t i = 0; i < refusal_count; i++)
    if ((!key || strcmp(refusals[i].key, key) > 0) && (!next || strcmp(refusals[i].key, next) < 0))
      next = refusals[i].key;
  return next;
}

static void document_refusals(FILE *f)
{
  fputs("<!-- keys: What may not stand together -->\n## What may not stand together\n\n"
        "A scene that says so is refused at the key of the first column.\n\n"
        "| key | what is wrong; what is allowed |\n| --- | --- |\n",
        f);
  for (const char *key = next_refused(NULL); key; key = next_refused(key)) {
    bool told = false;
    for (size_t i = 0; i < refusal_count; i++) {
      if (strcmp(refusals[i].key, key) != 0)
        continue;
      const char *quote = told || !*key ? "" : "`";
      fprintf(f, "| %s%s%s | ", quote, told ? "" : *key ? key : "the whole", quote);
      write_cell(f, refusals[i].why);
      fputs(" |\n", f);
      told = true;
    }
  }
  fputs("\n<!-- end of keys -->\n", f);
}

void scene_document(FILE *f)
{
  document_table(f, &scene_keys);
  document_sections(f, &scene_keys);
  document_refusals(f);
  meaning_document(f);
}
