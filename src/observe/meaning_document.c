#include <string.h>

#include "observe/meaning.h"

static void write_columns(FILE *f, const char *columns)
{
  for (const char *c = columns ? columns : ""; *c; c += *c == ' ') {
    const int length = (int)strcspn(c, " ");
    fprintf(f, "%s`%.*s`", c == columns ? "" : ", ", length, c);
    c += length;
  }
  fputs(columns ? "" : "all", f);
}

void meaning_document(FILE *f)
{
  static const char *const before[] = {[MEANS] = "", [LEFT_OUT] = "left out: ", [REFUSED] = "**refused**: "};
  fputs("<!-- table: meanings -->\n| observable | where | columns | what is read |\n| --- | --- | --- | --- |\n", f);
  for (size_t k = 0; k < meaning_count; k++) {
    const struct meaning *m = &meanings[k];
    fprintf(f, "| %s | %s | ", k == 0 || m->of != m[-1].of ? observable_names[m->of] : "", meaning_words(m->where));
    write_columns(f, m->columns);
    fprintf(f, " | %s%s |\n", before[m->verdict], m->text);
  }
  fputs("<!-- end of table -->\n", f);
}
