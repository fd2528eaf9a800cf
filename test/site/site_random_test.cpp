#include "test/site/disturbance.hpp"

#include <chrono>
#include <cstdlib>
#include <iostream>

/// Random faults at a whole site, then calm: docs/operations.md says how to
/// run many seeds, or one that has failed.
namespace {

using namespace roscell;
using namespace roscell::test;

/// What the suite spends on seeds, of the wall's clock.
constexpr std::chrono::seconds default_span{25};

/// Failures whose traces are printed; without a wanted number of seeds the run
/// ends there.
constexpr unsigned most_traces = 3;

unsigned number_from(const char* variable, unsigned otherwise) {
  const auto* text = std::getenv(variable);
  return text ? static_cast<unsigned>(std::stoul(text)) : otherwise;
}

/// True if the run ended well; else what is wrong has been printed, with a
/// trace if there shall be one.
bool ends_well(virtual_time& clock, uint32_t seed, bool trace) {
  disturbance x{clock, seed};
  x.run();
  const auto left = x.verdict();
  if (trace && (!left.empty() || std::getenv("ROSCELL_SEED")))
    print_events(x.place());
  if (!left.empty())
    std::cerr << "ROSCELL_SEED=" << seed << " fails: " << left << std::endl;
  return left.empty();
}

TEST_CASE("after any fault a site agrees on where every node and task is",
          "[random]") {
  virtual_time clock;
  if (std::getenv("ROSCELL_SEED")) {
    CHECK(ends_well(clock, number_from("ROSCELL_SEED", 0), true));
    return;
  }
  const auto wanted = number_from("ROSCELL_SITE_SEEDS", 0);
  // The same in every run of the suite, which must not fail by chance.
  const auto first = number_from("ROSCELL_FIRST", 1);
  const auto end = std::chrono::steady_clock::now() + default_span;
  const auto goes_on = [&](unsigned runs, unsigned bad) {
    if (wanted > 0)
      return runs < wanted;
    return bad < most_traces && std::chrono::steady_clock::now() < end;
  };
  unsigned count = 0, failures = 0;
  while (goes_on(count, failures))
    failures +=
        ends_well(clock, first + count++, failures < most_traces) ? 0 : 1;
  std::cerr << count << " seeds from " << first << ", " << failures << " bad\n";
  CHECK(failures == 0);
}

} // namespace
