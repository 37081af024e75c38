#include "topology/alexander.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "contact/determinant.h"

struct entry {
  uint32_t column;
  uint64_t value;
};

/* Entries in the order of their columns. */
struct sparse_row {
  struct entry *entry;
  uint32_t entries, room;
};

/* Rows that have or once had an entry in it; and how many have one. */
struct sparse_column {
  uint32_t *row;
  uint32_t rows, room, count;
};

/* --- numbers modulo a prime ----------------------------------------------------------------------------------------
 */

/* With 2^61 = c modulo the prime, c < 2^16: first below 2^77 + 2^61, then below 2^61 + 2^32. */
static uint64_t times(uint64_t a, uint64_t b, uint64_t prime)
{
  const uint64_t c = ALEXANDER_ABOVE - prime, mask = ALEXANDER_ABOVE - 1;
  const uint128 product = (uint128)a * b;
  const uint128 once = (product >> 61) * c + ((uint64_t)product & mask);
  const uint64_t twice = (uint64_t)(once >> 61) * c + ((uint64_t)once & mask);
  return twice >= prime ? twice - prime : twice;
}

static uint64_t minus(uint64_t a, uint64_t b, uint64_t prime)
{
  return a >= b ? a - b : a + (prime - b);
}

/* a^(prime - 2) */
static uint64_t inverse(uint64_t a, uint64_t prime)
{
  uint64_t result = 1;
  for (uint64_t e = prime - 2; e > 0; e >>= 1) {
    if (e & 1)
      result = times(result, a, prime);
    a = times(a, a, prime);
  }
  return result;
}

/* --- the matrix ----------------------------------------------------------------------------------------------------
 */

void alexander_free(struct alexander *a)
{
  for (uint32_t k = 0; k < a->room; k++) {
    free(a->row[k].entry);
    free(a->column[k].row);
  }
  free(a->row);
  free(a->column);
  free(a->open);
  free(a->sum);
  *a = (struct alexander){0};
}

static bool have_room(struct alexander *a, uint32_t size)
{
  if (size <= a->room)
    return true;
  if (!memory_grow((void **)&a->row, size, sizeof *a->row) ||
      !memory_grow((void **)&a->column, size, sizeof *a->column) ||
      !memory_grow((void **)&a->open, size, sizeof *a->open) || !memory_grow((void **)&a->sum, size, sizeof *a->sum))
    return false;
  memset(a->row + a->room, 0, (size - a->room) * sizeof *a->row);
  memset(a->column + a->room, 0, (size - a->room) * sizeof *a->column);
  a->room = size;
  return true;
}

static bool note_row(struct sparse_column *c, uint32_t row)
{
  if (c->rows == c->room && !memory_double((void **)&c->row, &c->room, 8, sizeof *c->row))
    return false;
  c->row[c->rows++] = row;
  return true;
}

/* Adds to an entry of a row that is being made. */
static bool add_entry(struct sparse_row *r, uint32_t column, uint64_t value, uint64_t prime)
{
  uint32_t k = 0;
  while (k < r->entries && r->entry[k].column < column)
    k++;
  if (k < r->entries && r->entry[k].column == column) {
    r->entry[k].value = minus(r->entry[k].value, prime - value, prime);
    if (r->entry[k].value == 0)
      memmove(&r->entry[k], &r->entry[k + 1], (--r->entries - k) * sizeof *r->entry);
    return true;
  }
  if (r->entries == r->room && !memory_double((void **)&r->entry, &r->room, 8, sizeof *r->entry))
    return false;
  memmove(&r->entry[k + 1], &r->entry[k], (r->entries++ - k) * sizeof *r->entry);
  r->entry[k] = (struct entry){column, value};
  return true;
}

static bool fill(struct alexander *a, const struct diagram *d, uint32_t size, uint64_t t, uint64_t prime)
{
  bool ok = true;
  for (uint32_t k = 0; k < size; k++)
    a->column[k].rows = a->column[k].count = 0;
  for (uint32_t k = 0; ok && k < size; k++) {
    const struct crossing *c = &d->crossing[k];
    const uint64_t part[3] = {minus(1, t, prime), c->sign > 0 ? t : prime - 1, c->sign > 0 ? prime - 1 : t};
    const uint32_t arc[3] = {c->over, c->in, c->out};
    struct sparse_row *r = &a->row[k];
    r->entries = 0;
    for (int j = 0; ok && j < 3; j++)
      ok = arc[j] == size || part[j] == 0 || add_entry(r, arc[j], part[j], prime);
    for (uint32_t j = 0; ok && j < r->entries; j++) {
      struct sparse_column *column = &a->column[r->entry[j].column];
      column->count++;
      ok = note_row(column, k);
    }
    a->open[k] = k;
  }
  return ok;
}

/* --- elimination ---------------------------------------------------------------------------------------------------
 */

static const struct entry *find_entry(const struct sparse_row *r, uint32_t column)
{
  uint32_t low = 0, high = r->entries;
  while (low < high) {
    const uint32_t middle = (low + high) / 2;
    if (r->entry[middle].column < column)
      low = middle + 1;
    else
      high = middle;
  }
  return low < r->entries && r->entry[low].column == column ? &r->entry[low] : NULL;
}

/* row = scale row - factor pivot row: so no pivot is inverted. */
static bool subtract(struct alexander *a, uint32_t row, const struct sparse_row *pivot, uint64_t scale, uint64_t factor,
                     uint64_t prime)
{
  struct sparse_row *r = &a->row[row];
  uint32_t i = 0, j = 0, n = 0;
  while (i < r->entries || j < pivot->entries) {
    const uint32_t ours = i < r->entries ? r->entry[i].column : UINT32_MAX;
    const uint32_t theirs = j < pivot->entries ? pivot->entry[j].column : UINT32_MAX;
    if (ours < theirs) {
      a->sum[n++] = (struct entry){ours, times(scale, r->entry[i++].value, prime)};
      continue;
    }
    const uint64_t product = times(factor, pivot->entry[j++].value, prime);
    const uint64_t value = minus(ours == theirs ? times(scale, r->entry[i].value, prime) : 0, product, prime);
    struct sparse_column *c = &a->column[theirs];
    if (value != 0)
      a->sum[n++] = (struct entry){theirs, value};
    if (ours == theirs) {
      i++;
      c->count -= value == 0;
    } else {
      c->count++;
      if (!note_row(c, row))
        return false;
    }
  }
  while (n > r->room)
    if (!memory_double((void **)&r->entry, &r->room, 8, sizeof *r->entry))
      return false;
  memcpy(r->entry, a->sum, n * sizeof *a->sum);
  r->entries = n;
  return true;
}

/* Of the open rows one with the fewest entries: its place among them. */
static uint32_t shortest_row(const struct alexander *a, uint32_t open)
{
  uint32_t best = 0;
  for (uint32_t k = 1; k < open && a->row[a->open[best]].entries > 1; k++)
    if (a->row[a->open[k]].entries < a->row[a->open[best]].entries)
      best = k;
  return best;
}

static const struct entry *rarest_column(const struct alexander *a, const struct sparse_row *r)
{
  const struct entry *best = r->entry;
  for (uint32_t k = 1; k < r->entries; k++)
    if (a->column[r->entry[k].column].count < a->column[best->column].count)
      best = &r->entry[k];
  return best;
}

/* The determinant grows by the pivot for each row that is scaled. */
static bool eliminate(struct alexander *a, uint32_t pivot_row, struct entry pivot, uint64_t *grown, uint64_t prime)
{
  struct sparse_row *r = &a->row[pivot_row];
  struct sparse_column *c = &a->column[pivot.column];
  for (uint32_t k = 0; k < c->rows && c->count > 1; k++) {
    const struct entry *e = c->row[k] == pivot_row ? NULL : find_entry(&a->row[c->row[k]], pivot.column);
    if (!e)
      continue;
    *grown = times(*grown, pivot.value, prime);
    if (!subtract(a, c->row[k], r, pivot.value, e->value, prime))
      return false;
  }
  for (uint32_t k = 0; k < r->entries; k++)
    a->column[r->entry[k].column].count--;
  c->rows = r->entries = 0; /* both are done with */
  return true;
}

bool alexander_value(struct alexander *a, const struct diagram *d, uint64_t t, uint64_t prime, uint64_t *value)
{
  const uint32_t size = d->crossings > 0 ? d->crossings - 1 : 0;
  *value = !d->split;
  if (d->split || size == 0)
    return true;
  if (!have_room(a, size) || !fill(a, d, size, t, prime))
    return false;
  uint64_t grown = 1;
  for (uint32_t open = size; open > 0; open--) {
    const uint32_t place = shortest_row(a, open), row = a->open[place];
    if (a->row[row].entries == 0) {
      *value = 0;
      return true;
    }
    const struct entry pivot = *rarest_column(a, &a->row[row]);
    *value = times(*value, pivot.value, prime);
    a->open[place] = a->open[open - 1];
    if (!eliminate(a, row, pivot, &grown, prime))
      return false;
  }
  *value = times(*value, inverse(grown, prime), prime);
  return true;
}
