/* Bonds that touch a bead, as scenes seldom have them: with an end, slow, grazing, at rest. */
#include "oracle/edges_touch.h"
#include "oracle/rows.h"

/* Bonds of 2^bond units along each axis at most, their ends moving by 2^rate units in a tick at most. end: touched with
 * an end. graze: they pass by in a depth of 2^graze units; 0: as they come. */
static const struct bead_kind {
  int bond, rate;
  bool end;
  int graze;
  uint32_t rows;
} kinds[] = {
    {39, 20, false, 0, 30}, {39, 20, true, 0, 30},   {39, 6, false, 0, 20},
    {36, 20, true, 0, 20},  {39, 21, false, 26, 20}, {39, 21, true, 26, 20},
};
enum { KINDS = sizeof kinds / sizeof *kinds };
_Static_assert(30 + 30 + 20 + 20 + 20 + 20 + EDGES_AT_REST <= ORACLE_TUBE_SEARCHES, "room");

/* R + D/2 of 1.5 to 2 a0. */
static int64_t draw_reach(struct dice *d)
{
  return 3 * ((int64_t)1 << 39) + dice_integer(d, (int64_t)1 << 38) + ((int64_t)1 << 38);
}

/* A bond, and a center at the reach from its side, or from an end and beyond it. */
static struct oracle_tubes draw_contact(struct dice *d, const struct bead_kind *k, int64_t reach)
{
  const struct point bond = dice_point(d, (int64_t)1 << k->bond);
  const struct vec3 p = edges_vector(bond), any = dice_vector(d, 1.0);
  const double s = k->end ? (double)(dice_u64(d) % 2) : dice_between(d, 0.1, 0.9), along = vec3_dot(any, p);
  struct vec3 n = vec3_add_scaled(any, -along / vec3_dot(p, p), p);
  if (k->end)
    n = vec3_scale((s > 0.5) == (along > 0.0) ? 1.0 : -1.0, any);
  const struct vec3 w = vec3_add_scaled(vec3_scale(s, p), (double)reach / vec3_norm(n), n);
  return (struct oracle_tubes){.p = bond, .w = {llrint(w.x), llrint(w.y), llrint(w.z)}};
}

static struct oracle_search draw_search(struct dice *d, const void *kind)
{
  const struct bead_kind *k = kind;
  const int64_t reach = draw_reach(d), rate = (int64_t)1 << k->rate, tick = (int64_t)(dice_u64(d) % FLIGHT_TICKS);
  const struct oracle_tubes c = draw_contact(d, k, reach);
  struct flight_pair f = {.p_rate = dice_point(d, rate), .w_rate = dice_point(d, rate)};
  f.p = flight_place(c.p, f.p_rate, -tick);
  f.w = flight_place(c.w, f.w_rate, -tick);
  return (struct oracle_search){.pair = f, .reach = reach};
}

bool oracle_edges_bead_searches(struct oracle_stage *g)
{
  struct oracle_search search[ORACLE_TUBE_SEARCHES];
  struct dice d = {89};
  uint32_t n = 0;
  for (int k = 0; k < KINDS; k++) {
    const struct edges_touch wanted = {draw_search, &kinds[k], (int64_t)1 << 40, kinds[k].graze, kinds[k].rows};
    n = edges_add_touches(&d, &wanted, search, n);
  }
  n = edges_add_at_rest(search, n);
  return oracle_add_rows(g, search, n, sizeof *search);
}

bool oracle_edges_bead_contacts(struct oracle_stage *g)
{
  struct oracle_tubes tubes[ORACLE_TUBE_CONTACTS];
  struct dice d = {97};
  enum { EACH = 20 };
  uint32_t n = 0;
  for (int k = 0; k < 4; k++)
    for (int row = 0; row < EACH; row++)
      tubes[n++] = draw_contact(&d, &kinds[k], draw_reach(&d));
  return oracle_add_rows(g, tubes, n, sizeof *tubes);
}
