#include "flow.h"

WallPair Flow::walls_at(int64_t half_intervals) const
{
  const double w = wave(half_intervals);
  return {{w * wall.at[0], w * wall.at[1]}};
}

__extension__ typedef __int128 Wide;

int64_t Flow::offset(const int64_t cells[3], double time_step, int64_t steps_between, int64_t half_steps) const
{
  const int64_t each = 2 * steps_between;
  const auto slide = [&](int64_t interval) { // in a half step
    return (Wide)nearest((((rate_during(interval) * (double)cells[1]) * 0.5) * time_step) * lattice_per_a0);
  };
  const auto slid = [&](int64_t time) { // since the beginning of interval 0
    const int64_t whole = time / each;
    Wide sum = intervals > 0 ? 0 : whole * slide(0);
    if (intervals > 0) {
      Wide period = 0;
      for (int64_t k = 0; k < intervals; k++) {
        period += slide(k);
        sum += k < whole % intervals ? slide(k) : 0;
      }
      sum += whole / intervals * period;
    }
    return sum * each + time % each * slide(whole);
  };
  const Wide edge = (Wide)cells[0] << 40, delta = (slid(half_steps + early) - slid(early)) % edge;
  return (int64_t)(delta < 0 ? delta + edge : delta);
}
