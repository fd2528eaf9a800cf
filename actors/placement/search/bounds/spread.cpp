#include "actors/placement/search/bounds/spread.hpp"

#include <algorithm>

namespace roscell::allocation {

namespace {

/// How far t lies above the interval, negative below it, 0 within it.
double beyond(const interval& one, double t) {
  return t > one.high ? t - one.high : std::min(t - one.low, 0.0);
}

/// Half of the derivative of the sum of squared distances, rising in t.
double slope(const interval* of, std::size_t count, double t) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i)
    sum += beyond(of[i], t);
  return sum;
}

} // namespace

double least_spread(const interval* of, std::size_t count) {
  if (count < 2)
    return 0;
  double lowest_high = of[0].high;
  double highest_low = of[0].low;
  for (std::size_t i = 1; i < count; ++i) {
    lowest_high = std::min(lowest_high, of[i].high);
    highest_low = std::max(highest_low, of[i].low);
  }
  if (highest_low <= lowest_high)
    return 0;
  // The slope is not positive at the lowest end. The last breakpoint where
  // that still holds starts the piece which holds the minimum.
  double start = lowest_high;
  double start_slope = slope(of, count, start);
  for (std::size_t i = 0; i < count; ++i)
    for (double end : {of[i].low, of[i].high}) {
      if (end <= start)
        continue;
      double here = slope(of, count, end);
      if (here <= 0) {
        start = end;
        start_slope = here;
      }
    }
  double outside = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (of[i].high <= start || of[i].low > start)
      ++outside;
  double t = outside > 0 ? start - start_slope / outside : start;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i)
    sum += beyond(of[i], t) * beyond(of[i], t);
  return sum;
}

} // namespace roscell::allocation
