#include "cli/check_observed.h"

#include <stdio.h>

#include "cli/sheet.h"
#include "observe/meaning.h"

/* A row that is worth a line: not what holds anywhere, nor what is left out since there is nothing of the kind. */
static bool is_told(const struct meaning *m, const struct scene *scene)
{
  const bool particular = m->verdict == MEANS ? m->where != ANYWHERE : m->where > NOTHING_OF_THE_KIND;
  return scene->observe.every[m->of] > 0 && particular && m->verdict != REFUSED &&
         meaning_holds(m->where, &scene->model);
}

void check_observed(const struct scene *scene)
{
  bool told = false;
  for (size_t k = 0; k < meaning_count; k++) {
    const struct meaning *m = &meanings[k];
    if (!is_told(m, scene))
      continue;
    if (!told)
      sheet_heading("What is read off (docs/observables.md)");
    told = true;
    printf("  %-11s %s%s: %s\n", observable_names[m->of], m->verdict == LEFT_OUT ? "left out, " : "",
           m->columns ? m->columns : "all columns", m->text);
  }
}
