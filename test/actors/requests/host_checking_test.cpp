#include "actors/requests/handlers/host_checking.hpp"

#include <catch2/catch.hpp>

#include <stdexcept>

namespace roscell::test {

TEST_CASE("A host is looked at by one at a time, and after a failure again",
          "[host_checking]") {
  int looks = 0;
  std::function<findings()> again;
  const auto look = one_at_a_time([&] {
    ++looks;
    if (looks == 1)
      throw std::runtime_error{"no thread is left"};
    CHECK(again().empty());
    return findings{{judgement::ok, "well"}};
  });
  again = look;
  CHECK_THROWS(look());
  CHECK(look().size() == 1);
  CHECK(looks == 2);
}

TEST_CASE("A program that cannot look at its host says nothing",
          "[host_checking]") {
  CHECK_FALSE(one_at_a_time(nullptr));
}

} // namespace roscell::test
