#include "actors/node/resource_probe.hpp"

#include "test/actors/edge/host/host_probe_fixture.hpp"
#include "test/fixture.hpp"

#include <unistd.h>

namespace roscell::test {

using namespace std::chrono_literals;

namespace {

/// A probe of a host with four cores and a load average of 1.5.
struct probe_fixture {
  virtual_time time;
  fixture_root root;
  resource_probe_actor probe;

  probe_fixture() {
    root.write("/sys/devices/system/cpu/online", "0-3\n");
    root.write("/proc/loadavg", "1.50 0.90 0.40 2/345 6789\n");
    use_cpu(100);
    resource_probe_config config;
    config.host.root = root.path();
    config.host.data_dir = root.path();
    config.host.nvml_library = "libno-such-library.so.1";
    config.host.affinity_cores = 64;
    // Not detached here: the test's time is virtual, its files are not.
    probe = spawn(time.system, time.context, resource_probe, config);
    time.settle();
  }

  ~probe_fixture() {
    time.kill(probe);
  }

  probe_fixture(const probe_fixture&) = delete;
  probe_fixture& operator=(const probe_fixture&) = delete;

  /// Seconds that the cores have been busy since the host's start.
  void use_cpu(long long seconds) {
    root.write("/proc/stat",
               "cpu  " + std::to_string(seconds * sysconf(_SC_CLK_TCK))
                   + " 0 0 99999 88888 0 0 0 0 0\n");
  }

  /// The answer that is there without any time passing.
  std::optional<double> cpu_at_once() {
    const auto reply = time.ask<host_measured>(probe, measure_host{});
    time.settle();
    if (!*reply || !**reply)
      return std::nullopt;
    return (***reply).resources.cpu.used;
  }

  void beat() {
    caf::anon_send(probe, mark_sample{});
    time.settle();
  }
};

} // namespace

TEST_CASE_METHOD(probe_fixture,
                 "A node that has just started is measured at once",
                 "[resource_probe]") {
  CHECK(cpu_at_once() == Approx(1.5));
}

TEST_CASE_METHOD(probe_fixture, "After a long quiet a node is measured at once",
                 "[resource_probe]") {
  time.pass(10min);
  CHECK(cpu_at_once() == Approx(1.5));
  CHECK(cpu_at_once() == Approx(1.5));
}

TEST_CASE_METHOD(probe_fixture,
                 "A measurement is the base of the next one's CPU rate",
                 "[resource_probe]") {
  time.pass(10min);
  REQUIRE(cpu_at_once());
  time.pass(2s);
  use_cpu(106);
  CHECK(cpu_at_once() == Approx(3.0));
}

TEST_CASE_METHOD(probe_fixture, "Beats keep the CPU rate one of now",
                 "[resource_probe]") {
  for (int i = 0; i < 30; ++i) {
    time.pass(4s);
    beat();
  }
  time.pass(2s);
  use_cpu(104);
  CHECK(cpu_at_once() == Approx(2.0));
}

TEST_CASE_METHOD(probe_fixture, "A resting probe sets no alarm",
                 "[resource_probe]") {
  REQUIRE(cpu_at_once());
  beat();
  CHECK_FALSE(time.scheduler.clock().has_pending_timeout());
}

} // namespace roscell::test
