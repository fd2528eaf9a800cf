#pragma once

#include "tools/roscell/doctor/checked_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <cstdint>

namespace roscell::cli {

/// What the kernel knows of the clock that people and messages go by.
struct clock_readings {
  bool reported = false;
  bool synchronised = false;
  int64_t most_error_us = 0; ///< How wrong it may be.
};

clock_readings read_clock();

finding judge_clock(const clock_readings& clock);

findings check_clock(const checked_host& host);

} // namespace roscell::cli
