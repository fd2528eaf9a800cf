#include "actors/edge/host/host_probe.hpp"

#include "actors/edge/host/host_probe_capacity.hpp"
#include "actors/edge/host/host_probe_files.hpp"
#include "actors/edge/limits.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <utility>

#include <sched.h>
#include <sys/statvfs.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace roscell {

namespace {

using namespace std::chrono_literals;

constexpr std::size_t max_devices = 256;

/// What robots and their accelerators are reached by: folder below /dev, and
/// how the names in it begin.
constexpr std::array<std::pair<const char*, const char*>, 11> device_kinds{{
    {"", "video"},
    {"", "ttyUSB"},
    {"", "ttyACM"},
    {"", "ttyAMA"},
    {"", "ttyTHS"},
    {"", "i2c-"},
    {"", "spidev"},
    {"", "gpiochip"},
    {"", "nvidia"},
    {"dri/", "render"},
    {"input/", "event"},
}};

/// "0-3,5" counts 5. Empty or damaged text counts 0.
unsigned count_cpu_list(std::string_view text) {
  unsigned result = 0;
  while (!text.empty()) {
    auto part = text.substr(0, text.find_first_of(",\n"));
    text.remove_prefix(std::min(part.size() + 1, text.size()));
    auto dash = part.find('-');
    auto first = to_number(part.substr(0, dash));
    auto last = dash == std::string_view::npos
                    ? first
                    : to_number(part.substr(dash + 1));
    if (first && last && *first <= *last && *last < 65536)
      result += static_cast<unsigned>(*last - *first + 1);
  }
  return result;
}

unsigned online_cores(const std::string& root) {
  auto text = read_file(root + "/sys/devices/system/cpu/online", 4096);
  auto count = text ? count_cpu_list(*text) : 0;
  return count > 0 ? count
                   : static_cast<unsigned>(
                       std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)));
}

/// 0 when the kernel does not say.
unsigned own_affinity() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof(set), &set) != 0)
    return 0;
  return static_cast<unsigned>(CPU_COUNT(&set));
}

/// The values of /proc/meminfo in MiB.
std::map<std::string, double, std::less<>> read_meminfo(std::string_view text) {
  std::map<std::string, double, std::less<>> result;
  while (!text.empty()) {
    auto line = take_line(text);
    std::string key{take_word(line)};
    if (auto kib = to_number(take_word(line)))
      result[key] = static_cast<double>(*kib) / 1024.0;
  }
  return result;
}

bool contains(const std::optional<std::string>& text, const char* what) {
  return text && text->find(what) != std::string::npos;
}

/// The nearest folder at or above `path` that exists.
std::filesystem::path existing_part(std::filesystem::path path) {
  std::error_code ec;
  path = std::filesystem::absolute(path, ec);
  while (!std::filesystem::exists(path, ec) && path.has_relative_path())
    path = path.parent_path();
  return path;
}

} // namespace

std::string architecture_of(std::string_view machine) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> names{
      {{"x86_64", "amd64"},
       {"aarch64", "arm64"},
       {"armv7l", "arm"},
       {"i686", "386"},
       {"ppc64le", "ppc64le"}}};
  for (auto& [from, to] : names)
    if (from == machine)
      return std::string{to};
  return std::string{machine};
}

host_probe::host_probe(host_probe_options options)
    : options_(std::move(options)), gpu_probe_(options_.nvml_library) {}

bool host_probe::sample(clock::time_point now) {
  if (!samples_.empty()
      && now - samples_.back().at < limits::resource::sample_distance)
    return false;
  auto busy = busy_seconds();
  if (!busy)
    return false;
  samples_.push_back({now, *busy});
  if (samples_.size() > limits::resource::samples)
    samples_.pop_front();
  return true;
}

std::optional<double> host_probe::cpu_used(clock::time_point now) {
  auto base = std::find_if(samples_.rbegin(), samples_.rend(), [&](auto& x) {
    return now - x.at >= limits::resource::least_sample_age;
  });
  if (base == samples_.rend()
      || now - base->at > limits::resource::most_sample_age)
    return std::nullopt;
  auto busy = busy_seconds();
  if (!busy)
    return std::nullopt;
  std::chrono::duration<double> span = now - base->at;
  return std::max(0.0, (*busy - base->busy_seconds) / span.count());
}

host_resources host_probe::read(clock::time_point now,
                                const std::set<pid_t>& own) {
  host_resources result;
  utsname system{};
  if (uname(&system) == 0)
    result.architecture = architecture_of(system.machine);
  result.unified_memory = is_jetson();
  result.cpu.capacity = online_cores(options_.root);
  const auto rate = cpu_used(now);
  result.cpu_estimated = !rate;
  result.cpu.used = rate ? *rate : load_estimate();
  result.memory_mib = memory();
  result.disk_mib = disk();
  result.gpus = gpus(result.unified_memory, own);
  result.devices = devices();
  capacity_bound affinity;
  auto cores =
      options_.affinity_cores != 0 ? options_.affinity_cores : own_affinity();
  if (cores != 0)
    affinity.cpu = cores;
  return apply_bound(apply_bound(std::move(result), affinity),
                     cgroup_bound(options_.root));
}

/// proc(5), /proc/loadavg: "1.50 0.90 0.40 2/345 6789", the fourth being the
/// threads that run or could, this one among them.
double host_probe::load_estimate() const {
  const auto text = read_file(options_.root + "/proc/loadavg", 256);
  if (!text)
    return 0;
  std::string_view rest{*text};
  const auto average = to_fraction(take_word(rest)).value_or(0);
  take_word(rest);
  take_word(rest);
  const auto threads = take_word(rest);
  const auto running = to_number(threads.substr(0, threads.find('/')));
  const auto others = static_cast<double>(running.value_or(1)) - 1;
  const double cores = online_cores(options_.root);
  return std::clamp(std::max(average, others), 0.0, cores);
}

/// proc(5), /proc/stat: user nice system idle iowait irq softirq steal, in
/// clock ticks. A core that waits for a disk is free; one whose hypervisor
/// gives its time to others is not.
std::optional<double> host_probe::busy_seconds() const {
  auto text = read_file(options_.root + "/proc/stat", 1024);
  if (!text)
    return std::nullopt;
  std::string_view rest{*text};
  if (take_word(rest) != "cpu")
    return std::nullopt;
  constexpr std::array<bool, 8> is_busy{true,  true, true, false,
                                        false, true, true, true};
  long long ticks = 0;
  for (bool busy : is_busy) {
    auto value = to_number(take_word(rest));
    if (!value)
      return std::nullopt;
    ticks += busy ? *value : 0;
  }
  return static_cast<double>(ticks) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

bool host_probe::is_jetson() const {
  auto& root = options_.root;
  std::error_code ec;
  return contains(read_file(root + "/proc/device-tree/compatible", 4096),
                  "nvidia,tegra")
         || contains(read_file(root + "/proc/device-tree/model", 4096),
                     "NVIDIA Jetson")
         || std::filesystem::exists(root + "/etc/nv_tegra_release", ec);
}

amount host_probe::memory() const {
  auto values =
      read_meminfo(read_file(options_.root + "/proc/meminfo").value_or(""));
  amount result;
  result.capacity = values["MemTotal:"];
  // Kernels before 3.14 do not estimate what is available.
  auto available = values.count("MemAvailable:") != 0
                       ? values["MemAvailable:"]
                       : values["MemFree:"] + values["Cached:"];
  result.used = std::max(0.0, result.capacity - available);
  return result;
}

amount host_probe::disk() const {
  amount result;
  struct statvfs at {};
  if (statvfs(existing_part(options_.data_dir).c_str(), &at) != 0)
    return result;
  auto mib = static_cast<double>(at.f_frsize) / (1024.0 * 1024.0);
  result.capacity = static_cast<double>(at.f_blocks) * mib;
  result.used = result.capacity - static_cast<double>(at.f_bavail) * mib;
  return result;
}

std::vector<std::string> host_probe::devices() const {
  std::vector<std::string> result;
  for (auto& [folder, prefix] : device_kinds) {
    std::error_code ec;
    std::string below = std::string{"/dev/"} + folder;
    for (std::filesystem::directory_iterator i{options_.root + below, ec}, end;
         !ec && i != end && result.size() < max_devices; i.increment(ec)) {
      auto name = i->path().filename().string();
      if (name.rfind(prefix, 0) == 0 && !i->is_directory(ec))
        result.push_back(below + name);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<gpu_resources> host_probe::gpus(bool unified_memory,
                                            const std::set<pid_t>& own) {
  // A Jetson has one GPU and no memory of its own; its NVML, where there is
  // one, says nothing more.
  if (unified_memory)
    return {gpu_resources{}};
  return gpu_probe_.read(own);
}

} // namespace roscell
