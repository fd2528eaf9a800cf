#include "actors/edge/host/descriptor_limit.hpp"

#include <catch2/catch.hpp>

#include <sys/resource.h>

namespace roscell::test {

TEST_CASE("A node may open as many descriptors as the host lets it",
          "[descriptor_limit]") {
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &before) == 0);
  auto low = before;
  low.rlim_cur = 256;
  REQUIRE(::setrlimit(RLIMIT_NOFILE, &low) == 0);
  CHECK(raise_descriptor_limit() == before.rlim_max);
  rlimit after{};
  CHECK(::getrlimit(RLIMIT_NOFILE, &after) == 0);
  CHECK(after.rlim_cur == before.rlim_max);
  CHECK(::setrlimit(RLIMIT_NOFILE, &before) == 0);
}

} // namespace roscell::test
