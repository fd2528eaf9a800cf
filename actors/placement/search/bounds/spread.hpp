#pragma once

#include <cstddef>

namespace roscell::allocation {

/// A number known only to lie between two others.
struct interval {
  double low = 0;
  double high = 0;
};

/// The least sum of squared deviations from their mean that numbers within
/// these intervals can have. Since a mean minimises the squared deviations,
/// it is the minimum over t of the sum of squared distances from t to the
/// intervals, a convex and piecewise quadratic function. Takes time
/// quadratic in `count`.
double least_spread(const interval* of, std::size_t count);

} // namespace roscell::allocation
