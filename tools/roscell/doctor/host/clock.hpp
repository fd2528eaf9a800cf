#pragma once

#include "tools/roscell/doctor/examined_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <cstdint>

namespace roscell::cli {

/// What the kernel knows of the clock that people and messages go by.
struct clock_facts {
  bool told = false;
  bool synchronised = false;
  int64_t most_error_us = 0; ///< How wrong it may be.
};

clock_facts look_at_clock();

finding judge_clock(const clock_facts& clock);

findings examine_clock(const examined_host& host);

} // namespace roscell::cli
