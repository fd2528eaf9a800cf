#include "tools/roscell/doctor/host/clock.hpp"

#include "tools/roscell/view/format.hpp"

#include <sys/timex.h>

namespace roscell::cli {

clock_readings read_clock() {
  timex clock{};
  const auto state = adjtimex(&clock);
  if (state < 0)
    return {};
  return {true, state != TIME_ERROR && (clock.status & STA_UNSYNC) == 0,
          clock.maxerror};
}

finding judge_clock(const clock_readings& clock) {
  if (!clock.reported)
    return {judgement::skipped, "the kernel does not report it"};
  constexpr auto why =
      "ages of frames between hosts, and the order of events and logs, are as "
      "wrong as the clocks differ";
  constexpr auto synchronise = "sudo timedatectl set-ntp true";
  if (!clock.synchronised)
    return {judgement::warning, "nothing synchronises the clock of this host",
            why, synchronise};
  // What a frame's age is good for is some milliseconds.
  constexpr int64_t most_error_us = 500'000;
  const auto seen =
      "the clock is synchronised, and wrong by "
      + format_number(static_cast<double>(clock.most_error_us) / 1000, 1)
      + " ms at most";
  if (clock.most_error_us > most_error_us)
    return {judgement::warning, seen, why,
            "chronyc tracking || timedatectl status"};
  return {judgement::ok, seen};
}

findings check_clock(const checked_host& /*host*/) {
  return {judge_clock(read_clock())};
}

} // namespace roscell::cli
