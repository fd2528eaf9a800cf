#include "client/instance_text.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

TEST_CASE("what an instance takes is shown with what it may or has asked for",
          "[client]") {
  instance_row row;
  row.spec.resources = {0.5, 64, 1};
  row.metrics.use.memory_mib = 61.4;
  row.metrics.use.cpu = 0.346;
  CHECK(memory_text(row) == "61 MiB of 64 MiB");
  CHECK(cpu_text(row) == "0.35 of 0.5");
  row.metrics.use.memory_limit_mib = 128;
  CHECK(memory_text(row) == "61 MiB of 128 MiB");
  row.spec.resources = {};
  row.metrics.use.memory_limit_mib = -1;
  CHECK(memory_text(row) == "61 MiB");
  CHECK(cpu_text(row) == "0.35");
  row.metrics = {};
  CHECK(memory_text(row).empty());
  CHECK(cpu_text(row).empty());
}

TEST_CASE("what a program says is shown beside what its node has read",
          "[client]") {
  instance_row row;
  row.state = instance_state::running;
  row.metrics.use.memory_mib = 10;
  row.metrics.use.cpu = 0.1;
  row.status = "waiting for a map";
  CHECK(remark(row, 0) == "waiting for a map");
}
