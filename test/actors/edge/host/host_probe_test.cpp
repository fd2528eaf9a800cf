#include "actors/edge/host/host_probe.hpp"
#include "actors/edge/limits.hpp"
#include "test/places.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

/// The first line of /proc/stat of a host with this many busy seconds.
std::string stat_after(long long user_seconds, long long system_seconds = 0) {
  auto ticks = sysconf(_SC_CLK_TCK);
  return "cpu  " + std::to_string(user_seconds * ticks) + " 0 "
         + std::to_string(system_seconds * ticks)
         + " 99999 88888 0 0 0 0 0\ncpu0 1 2 3 4 5 6 7 8 9 10\n";
}

host_probe_options options_for(const temp_folder& root) {
  host_probe_options result;
  result.root = root.path();
  result.data_dir = root.path();
  result.nvml_library = "libno-such-library.so.1";
  result.affinity_cores = 64;
  return result;
}

/// A host with four cores and 8000 MiB, of which 3000 are in use.
struct four_core_host : temp_folder {
  four_core_host() {
    write("/proc/stat", stat_after(100));
    write("/proc/meminfo", "MemTotal:        8192000 kB\n"
                           "MemFree:          100000 kB\n"
                           "MemAvailable:    5120000 kB\n");
    write("/sys/devices/system/cpu/online", "0-2,7\n");
  }
};

const host_probe::clock::time_point start{1000s};

} // namespace

TEST_CASE("a host's memory, cores, disk and architecture are read",
          "[host_probe]") {
  four_core_host root;
  host_probe probe{options_for(root)};
  auto host = probe.read(start);
  CHECK(host.cpu.capacity == 4);
  CHECK(host.memory_mib.capacity == 8000);
  CHECK(host.memory_mib.used == 3000);
  CHECK(host.disk_mib.capacity > 0);
  CHECK(host.disk_mib.used >= 0);
  CHECK(host.disk_mib.used <= host.disk_mib.capacity);
  CHECK_FALSE(host.architecture.empty());
  CHECK_FALSE(host.unified_memory);
  CHECK(host.gpus.empty());
  CHECK(host.devices.empty());
}

TEST_CASE("CPU use is the rate since a sample of at least a second ago",
          "[host_probe]") {
  four_core_host root;
  host_probe probe{options_for(root)};
  CHECK_FALSE(probe.cpu_used(start));
  probe.sample(start);
  CHECK_FALSE(probe.cpu_used(start + 999ms));
  root.write("/proc/stat", stat_after(102, 4));
  CHECK(probe.cpu_used(start + 2s) == Approx(3.0));
  CHECK(probe.read(start + 2s).cpu.used == Approx(3.0));
  CHECK(probe.read(start).cpu.used == 0);
}

TEST_CASE("of several samples the newest that is old enough counts",
          "[host_probe]") {
  four_core_host root;
  host_probe probe{options_for(root)};
  probe.sample(start);
  root.write("/proc/stat", stat_after(110));
  probe.sample(start + 5s);
  root.write("/proc/stat", stat_after(112));
  probe.sample(start + 6500ms);
  root.write("/proc/stat", stat_after(113));
  CHECK(probe.cpu_used(start + 7s) == Approx(1.5));
}

TEST_CASE("many samples in a row leave one that is a second old",
          "[host_probe]") {
  four_core_host root;
  host_probe probe{options_for(root)};
  for (auto at = 0ms; at <= 3000ms; at += 1ms)
    probe.sample(start + at);
  CHECK(probe.cpu_used(start + 3s) == Approx(0.0));
}

TEST_CASE("a sample of long ago is no base for a rate", "[host_probe]") {
  four_core_host root;
  host_probe probe{options_for(root)};
  probe.sample(start);
  CHECK(probe.cpu_used(start + limits::resource::most_sample_age));
  CHECK_FALSE(probe.cpu_used(start + limits::resource::most_sample_age + 1ms));
}

TEST_CASE("without a sample in time the load average tells the CPU's use",
          "[host_probe]") {
  four_core_host root;
  root.write("/proc/loadavg", "1.50 0.90 0.40 2/345 6789\n");
  host_probe probe{options_for(root)};
  CHECK(probe.read(start).cpu.used == Approx(1.5));
  CHECK(probe.read(start).cpu_estimated);
  probe.sample(start);
  CHECK(probe.read(start + 2s).cpu.used == Approx(0.0));
  CHECK_FALSE(probe.read(start + 2s).cpu_estimated);
  CHECK(probe.read(start + 40s).cpu.used == Approx(1.5));
}

TEST_CASE("without a sample what runs right now counts, but for the asker",
          "[host_probe]") {
  four_core_host root;
  host_probe probe{options_for(root)};
  root.write("/proc/loadavg", "0.20 0.10 0.05 4/345 6789\n");
  CHECK(probe.load_estimate() == 3);
  root.write("/proc/loadavg", "0.20 0.10 0.05 1/345 6789\n");
  CHECK(probe.load_estimate() == Approx(0.2));
}

TEST_CASE("a load says at most that all cores are in use", "[host_probe]") {
  four_core_host root;
  host_probe probe{options_for(root)};
  root.write("/proc/loadavg", "17.03 9.01 4.00 2/345 6789\n");
  CHECK(probe.load_estimate() == 4);
  for (const char* text :
       {"", "x", "nan 1 1", "inf 1 1", "-1 1 1", "1e3 1 1"}) {
    CAPTURE(text);
    root.write("/proc/loadavg", text);
    CHECK(probe.load_estimate() == 0);
  }
}

TEST_CASE("damaged files of /proc give no numbers and no crash",
          "[host_probe]") {
  for (const char* text :
       {"", "cpu", "cpu 1 2", "cpu a b c d e f g h", "intr 1 2 3 4 5 6 7 8",
        "cpu 99999999999999999999 1 1 1 1 1 1 1"}) {
    CAPTURE(text);
    temp_folder root;
    root.write("/proc/stat", text);
    root.write("/proc/loadavg", text);
    root.write("/proc/meminfo", text);
    root.write("/proc/self/cgroup", text);
    root.write("/sys/devices/system/cpu/online", text);
    host_probe probe{options_for(root)};
    probe.sample(start);
    CHECK_FALSE(probe.cpu_used(start + 2s));
    auto host = probe.read(start);
    CHECK(host.memory_mib.capacity == 0);
    CHECK(host.cpu.capacity >= 1);
  }
}

TEST_CASE("a process that may run on fewer cores offers these",
          "[host_probe]") {
  four_core_host root;
  auto options = options_for(root);
  options.affinity_cores = 1;
  CHECK(host_probe{options}.read(start).cpu.capacity == 1);
}

TEST_CASE("a cgroup's quota and limit bound what a host offers",
          "[host_probe]") {
  four_core_host root;
  SECTION("version 2, the tightest of the ancestors") {
    root.write("/proc/self/cgroup", "0::/robots/node\n");
    root.write("/sys/fs/cgroup/robots/node/cpu.max", "max 100000\n");
    root.write("/sys/fs/cgroup/robots/cpu.max", "150000 100000\n");
    root.write("/sys/fs/cgroup/robots/node/memory.max", "2097152000\n");
    root.write("/sys/fs/cgroup/robots/memory.max", "max\n");
  }
  SECTION("version 2 inside a container, whose cgroup is the root") {
    root.write("/proc/self/cgroup", "0::/\n");
    root.write("/sys/fs/cgroup/cpu.max", "150000 100000\n");
    root.write("/sys/fs/cgroup/memory.max", "2097152000\n");
  }
  SECTION("version 1, whose container does not see its own path") {
    root.write("/proc/self/cgroup", "5:memory:/docker/abc\n"
                                    "4:cpu,cpuacct:/docker/abc\n"
                                    "3:cpuset:/docker/abc\n");
    root.write("/sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "150000\n");
    root.write("/sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
    root.write("/sys/fs/cgroup/memory/memory.limit_in_bytes", "2097152000\n");
  }
  auto host = host_probe{options_for(root)}.read(start);
  CHECK(host.cpu.capacity == 1.5);
  CHECK(host.memory_mib.capacity == 2000);
  // 6000 MiB lie outside, the 3000 in use among them.
  CHECK(host.memory_mib.used == 0);
}

TEST_CASE("a cgroup without limits bounds nothing", "[host_probe]") {
  four_core_host root;
  root.write("/proc/self/cgroup", "0::/a\n4:cpu:/a\n5:memory:/a\nx\n:\n::\n");
  root.write("/sys/fs/cgroup/a/cpu.max", "max 100000\n");
  root.write("/sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "-1\n");
  root.write("/sys/fs/cgroup/cpu/a/cpu.cfs_period_us", "100000\n");
  root.write("/sys/fs/cgroup/memory/a/memory.limit_in_bytes",
             "9223372036854771712\n");
  auto host = host_probe{options_for(root)}.read(start);
  CHECK(host.cpu.capacity == 4);
  CHECK(host.memory_mib.capacity == 8000);
}

TEST_CASE("devices that skills ask for are listed by path, in order",
          "[host_probe]") {
  temp_folder root;
  for (const char* file :
       {"/dev/video1", "/dev/video0", "/dev/ttyUSB0", "/dev/ttyACM3",
        "/dev/dri/renderD128", "/dev/dri/card0", "/dev/nvidia0", "/dev/null",
        "/dev/nvidia-caps/cap1", "/dev/sda"})
    root.write(file, "");
  CHECK(host_probe{options_for(root)}.read(start).devices
        == std::vector<std::string>{"/dev/dri/renderD128", "/dev/nvidia0",
                                    "/dev/ttyACM3", "/dev/ttyUSB0",
                                    "/dev/video0", "/dev/video1"});
}

TEST_CASE("a Jetson has unified memory and one GPU without its own",
          "[host_probe]") {
  four_core_host root;
  SECTION("by what its device tree is compatible with") {
    root.write("/proc/device-tree/compatible",
               std::string{"nvidia,p3737-0000\0nvidia,tegra234\0", 33});
  }
  SECTION("by its model") {
    root.write("/proc/device-tree/model",
               std::string{"NVIDIA Jetson Orin Nano Developer Kit\0", 38});
  }
  SECTION("by its release file") {
    root.write("/etc/nv_tegra_release", "# R36 (release)");
  }
  auto options = options_for(root);
  options.nvml_library = test::fake_nvml();
  auto host = host_probe{options}.read(start);
  CHECK(host.unified_memory);
  REQUIRE(host.gpus.size() == 1);
  CHECK(host.gpus[0] == gpu_resources{});
}

TEST_CASE("a Raspberry Pi is no Jetson", "[host_probe]") {
  temp_folder root;
  root.write("/proc/device-tree/compatible",
             std::string{"raspberrypi,5-model-b\0brcm,bcm2712\0", 35});
  root.write("/proc/device-tree/model", "Raspberry Pi 5 Model B Rev 1.0");
  CHECK_FALSE(host_probe{options_for(root)}.read(start).unified_memory);
}

TEST_CASE("GPUs are read through NVML, but for those that do not answer",
          "[host_probe]") {
  temp_folder root;
  auto options = options_for(root);
  options.nvml_library = test::fake_nvml();
  host_probe probe{options};
  for (int i = 0; i < 2; ++i) {
    auto gpus = probe.read(start).gpus;
    REQUIRE(gpus.size() == 2);
    CHECK(gpus[0] == gpu_resources{0, "Fake GPU 0", {8192, 1024}});
    CHECK(gpus[1] == gpu_resources{2, "Fake GPU 2", {8194, 1026}});
  }
}

TEST_CASE("what programs outside our instances use of a GPU is used",
          "[host_probe]") {
  temp_folder root;
  auto options = options_for(root);
  options.nvml_library = test::fake_nvml();
  host_probe probe{options};
  auto used = [&](const std::set<pid_t>& own) {
    return probe.read(start, own).gpus.at(0).memory_mib.used;
  };
  CHECK(used({}) == 1024);
  CHECK(used({1}) == 1024);
  // It computes and draws, and counts once.
  CHECK(used({4242}) == 524);
  CHECK(used({4242, 4243}) == 324);
  // Its use is not known, so it counts as that of others.
  CHECK(used({4244}) == 1024);
}

TEST_CASE("a library that is not NVML gives no GPUs", "[host_probe]") {
  CHECK(gpu_probe{"libdl.so.2"}.read().empty());
  CHECK(gpu_probe{""}.read().empty());
}

TEST_CASE("a data directory that does not exist yet lies on its parent's disk",
          "[host_probe]") {
  temp_folder root;
  auto options = options_for(root);
  auto there = host_probe{options}.read(start).disk_mib.capacity;
  options.data_dir += "/not/yet/there";
  CHECK(host_probe{options}.read(start).disk_mib.capacity == there);
}

TEST_CASE("machines are named as container images name them", "[host_probe]") {
  CHECK(architecture_of("x86_64") == "amd64");
  CHECK(architecture_of("aarch64") == "arm64");
  CHECK(architecture_of("armv7l") == "arm");
  CHECK(architecture_of("riscv64") == "riscv64");
}

TEST_CASE("the host that runs this test can be read", "[host_probe]") {
  host_probe_options options;
  options.data_dir = ".";
  auto host = host_probe{options}.read(host_probe::clock::now());
  CHECK(host.cpu.capacity > 0);
  CHECK(host.memory_mib.capacity > host.memory_mib.used);
  CHECK(host.disk_mib.capacity > 0);
}
