#include "actors/placement/search/resources.hpp"

#include <algorithm>

namespace roscell::allocation {

bool shares::fit() const {
  return std::all_of(of.begin(), of.begin() + count,
                     [](const share& one) { return one.fits(); });
}

double shares::variance() const {
  std::array<double, resource_count> fractions{};
  double mean = 0;
  for (std::size_t i = 0; i < count; ++i) {
    fractions[i] = of[i].fraction();
    mean += fractions[i];
  }
  mean /= static_cast<double>(count);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i)
    sum += (fractions[i] - mean) * (fractions[i] - mean);
  return sum / static_cast<double>(count);
}

} // namespace roscell::allocation
