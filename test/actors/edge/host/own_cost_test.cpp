#include "actors/edge/host/own_cost.hpp"

#include "test/actors/edge/host/host_probe_fixture.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

namespace roscell::test {

TEST_CASE("a process's cost is read from the kernel's files", "[own_cost]") {
  fixture_root folder;
  const auto ticks = std::to_string(3 * sysconf(_SC_CLK_TCK));
  folder.write("/stat", "7 (a (b) c) S 1 2 3 4 5 6 7 8 9 10 " + ticks
                            + " 0 0 0 20 0 1 0 " + ticks + "00 4096\n");
  folder.write("/smaps_rollup", "0-1 ---p\nRss: 20 kB\nPss: 10 kB\n");
  folder.write("/io",
               "read_bytes: 1\nwrite_bytes: 4096\ncancelled_write_bytes: 0\n");
  const auto cost = read_own_cost(folder.path());
  CHECK(cost.cpu_seconds == Approx(3));
  CHECK(cost.started_s == Approx(300));
  CHECK(cost.resident_bytes == 20 * 1024);
  CHECK(cost.pss_bytes == 10 * 1024);
  CHECK(cost.written_bytes == 4096);
}

TEST_CASE("what the kernel does not tell costs nothing", "[own_cost]") {
  const fixture_root folder;
  const auto cost = read_own_cost(folder.path() + "/nobody");
  CHECK(cost.cpu_seconds == 0);
  CHECK(cost.pss_bytes == 0);
}

TEST_CASE("when the host was booted is the same at each look", "[own_cost]") {
  fixture_root folder;
  folder.write("/stat", "cpu  1 2 3 4\nintr 5 6\nbtime 1700000000\nctxt 7\n");
  CHECK(read_boot_time(folder.path() + "/stat") == 1'700'000'000);
  CHECK(read_boot_time(folder.path() + "/nobody") == 0);
  CHECK(read_boot_time() > 0);
  CHECK(read_boot_time() == read_boot_time());
}

TEST_CASE("this process has a cost", "[own_cost]") {
  const auto cost = read_own_cost();
  CHECK(cost.resident_bytes > 0);
  CHECK(cost.open_files > 0);
}

} // namespace roscell::test
