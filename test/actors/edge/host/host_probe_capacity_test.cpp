#include "actors/edge/host/host_probe_capacity.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

capacity_bound must_parse(std::string_view text) {
  auto result = parse_capacity(text);
  if (auto* error = std::get_if<edge_error>(&result))
    FAIL(error->message);
  return std::get<capacity_bound>(result);
}

host_resources sample() {
  host_resources host;
  host.cpu = {8, 3};
  host.memory_mib = {16000, 4000};
  host.disk_mib = {1000, 900};
  host.gpus = {{0, "a", {8000, 1000}}, {1, "b", {8000, 1000}}};
  return host;
}

} // namespace

TEST_CASE("a capacity names what it bounds", "[host_probe]") {
  auto bound = must_parse("cpu=2.5,memory_mib=2048,disk_mib=1000,"
                          "gpu0_memory_mib=4000,gpu12_memory_mib=0");
  CHECK(bound.cpu == 2.5);
  CHECK(bound.memory_mib == 2048);
  CHECK(bound.disk_mib == 1000);
  CHECK(bound.gpu_memory_mib == std::map<int, double>{{0, 4000}, {12, 0}});
  CHECK_FALSE(must_parse("").cpu);
  CHECK_FALSE(must_parse("cpu=1").memory_mib);
}

TEST_CASE("a wrong capacity is refused by the part that is wrong",
          "[host_probe]") {
  const std::pair<const char*, const char*> cases[] = {
      {"cpus=2", "capacity \"cpus=2\": unknown key \"cpus\""},
      {"cpu=1,gpu_memory_mib=3",
       "capacity \"gpu_memory_mib=3\": unknown key \"gpu_memory_mib\""},
      {"gpu-1_memory_mib=3",
       "capacity \"gpu-1_memory_mib=3\": unknown key \"gpu-1_memory_mib\""},
      {"cpu", "capacity \"cpu\": there is no \"=\""},
      {"cpu=1,,disk_mib=1", "capacity \"\": there is no \"=\""},
      {"cpu=1,", "capacity \",\": nothing follows the last comma"},
      {"cpu=1,cpu=2", "capacity \"cpu=2\": the key is given twice"},
      {"gpu1_memory_mib=1,gpu1_memory_mib=1",
       "capacity \"gpu1_memory_mib=1\": the key is given twice"},
      {"cpu=-1", "capacity \"cpu=-1\": the value must be a number from 0 to "
                 "1e12"},
  };
  for (auto& [text, message] : cases) {
    auto result = parse_capacity(text);
    REQUIRE(std::holds_alternative<edge_error>(result));
    auto& error = std::get<edge_error>(result);
    CHECK(error.code == error_code::schema_violation);
    CHECK(error.message == message);
    for (const char* key : {"cpu", "memory_mib", "disk_mib", "gpuN_memory_mib"})
      CHECK(error.hint.find(key) != std::string::npos);
  }
  for (const char* text : {"cpu=", "cpu=x", "cpu=1x", "cpu=nan", "cpu=inf",
                           "cpu= 1", "cpu=9999999999999", "=1"})
    CHECK(std::holds_alternative<edge_error>(parse_capacity(text)));
}

TEST_CASE("use by others lies outside the offered slice while there is room",
          "[host_probe]") {
  auto host = apply_bound(sample(), must_parse("cpu=6,memory_mib=2000"));
  CHECK(host.cpu == amount{6, 1});           // 3 used, 2 fit outside.
  CHECK(host.memory_mib == amount{2000, 0}); // 4000 used, 14000 fit outside.
}

TEST_CASE("a full host leaves a slice that is full", "[host_probe]") {
  auto host = apply_bound(sample(), must_parse("disk_mib=50,cpu=0"));
  CHECK(host.disk_mib == amount{50, 0});
  CHECK(host.cpu == amount{0, 0});
  auto busy = sample();
  busy.cpu.used = 9;
  CHECK(apply_bound(busy, must_parse("cpu=2")).cpu == amount{2, 3});
}

TEST_CASE("a bound above the host or on what is not there changes nothing",
          "[host_probe]") {
  auto host = apply_bound(
      sample(), must_parse("cpu=9,memory_mib=99999,gpu7_memory_mib=1"));
  CHECK(host.cpu == sample().cpu);
  CHECK(host.memory_mib == sample().memory_mib);
  CHECK(host.disk_mib == sample().disk_mib);
  CHECK(host.gpus == sample().gpus);
}

TEST_CASE("each GPU has its own bound", "[host_probe]") {
  auto host = apply_bound(sample(), must_parse("gpu1_memory_mib=7500"));
  CHECK(host.gpus[0].memory_mib == amount{8000, 1000});
  CHECK(host.gpus[1].memory_mib == amount{7500, 500});
}
