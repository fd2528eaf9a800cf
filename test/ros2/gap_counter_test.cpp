#include "skills/ros2/topic_input.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

TEST_CASE("messages that are missing between two of a writer are counted") {
  ros2::gap_counter gaps;
  const ros2::guid one{1};
  const ros2::guid two{2};
  CHECK(gaps.add(one, 17) == 0); // Those before are not ours.
  CHECK(gaps.add(one, 18) == 0);
  CHECK(gaps.add(one, 21) == 2);
  CHECK(gaps.add(two, 1) == 0);
  CHECK(gaps.add(one, 20) == 0); // Late, or twice: nothing is missing.
  CHECK(gaps.add(one, 22) == 0);
}
