#include "actors/node/resource_probe.hpp"

#include "test/fixture.hpp"
#include "test/places.hpp"
#include "test/temp_folder.hpp"

#include <unistd.h>

namespace roscell::test {

using namespace std::chrono_literals;

namespace {

/// A probe of a host with four cores and a load average of 1.5.
struct probe_fixture {
  virtual_time time;
  temp_folder root;
  resource_probe_actor probe;

  probe_fixture() {
    root.write("/sys/devices/system/cpu/online", "0-3\n");
    root.write("/proc/loadavg", "1.50 0.90 0.40 2/345 6789\n");
    use_cpu(100);
    resource_probe_config config;
    config.host.root = root.path();
    config.host.data_dir = root.path();
    config.host.nvml_library = test::fake_nvml();
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

  /// A process that uses GPU memory, 500 MiB by the fake NVML, and 10 s of
  /// CPU, in a container.
  void run_in_container(const std::string& container) {
    root.write("/proc/4242/stat",
               "4242 (skill) S 1 4242 4242 0 -1 0 0 0 0 0 "
                   + std::to_string(10 * sysconf(_SC_CLK_TCK))
                   + " 0 0 0 20 0 1 0 1 1 25600 0\n");
    root.write("/proc/4242/cgroup", "0::/docker/" + container + '\n');
    root.write("/proc/meminfo",
               "MemTotal: 4194304 kB\nMemAvailable: 2097152 kB\n");
  }

  node_resources resources(const measure_host& request) {
    const auto reply = time.ask<host_measured>(probe, request);
    time.settle();
    REQUIRE(*reply);
    REQUIRE(**reply);
    return (***reply).resources;
  }

  void heartbeat() {
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

TEST_CASE_METHOD(probe_fixture, "Heartbeats keep the CPU rate one of now",
                 "[resource_probe]") {
  for (int i = 0; i < 30; ++i) {
    time.pass(4s);
    heartbeat();
  }
  time.pass(2s);
  use_cpu(104);
  CHECK(cpu_at_once() == Approx(2.0));
}

TEST_CASE_METHOD(probe_fixture,
                 "What a container of ours uses does not count as that of "
                 "others, GPU memory least of all",
                 "[resource_probe]") {
  const std::string ours(64, 'c');
  const auto page_mib = static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576;
  run_in_container(ours);
  const auto others = resources({});
  CHECK(others.gpus.at(0).memory_mib.used == 1024);
  CHECK(others.memory_mib.used == Approx(2048));
  const auto known = resources({{}, {ours}});
  CHECK(known.gpus.at(0).memory_mib.used == 524);
  CHECK(known.memory_mib.used == Approx(2048 - 25600 * page_mib));
  CHECK(resources({{}, {std::string(64, 'd')}}).gpus.at(0).memory_mib.used
        == 1024);
}

TEST_CASE_METHOD(probe_fixture, "A resting probe sets no alarm",
                 "[resource_probe]") {
  REQUIRE(cpu_at_once());
  heartbeat();
  CHECK_FALSE(time.scheduler.clock().has_pending_timeout());
}

} // namespace roscell::test
