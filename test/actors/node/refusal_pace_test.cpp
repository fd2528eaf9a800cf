#include "actors/node/refusal_pace.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

TEST_CASE("one refusal an address and second is told of, with how many there "
          "were",
          "[node]") {
  refusal_pace pace;
  const refusal_pace::time_point begin{};
  CHECK(pace.count("a", begin) == 1);
  for (int i = 1; i < 200; ++i)
    CHECK(pace.count("a", begin + std::chrono::milliseconds{i}) == 0);
  CHECK(pace.count("b", begin) == 1);
  CHECK(pace.count("a", begin + refusal_pace::pause) == 200);
}

TEST_CASE("refusals of many addresses are not all kept", "[node]") {
  refusal_pace pace;
  const refusal_pace::time_point begin{};
  size_t reported = 0;
  for (int i = 0; i < 10'000; ++i)
    reported += pace.count("10.0.0." + std::to_string(i), begin);
  CHECK(reported == refusal_pace::most_addresses);
  CHECK(pace.count("late", begin + refusal_pace::pause) == 1);
}

} // namespace roscell::test
