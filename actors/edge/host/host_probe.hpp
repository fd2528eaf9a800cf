#pragma once

#include "actors/edge/host/gpu_probe.hpp"
#include "messages/resources.hpp"

#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// What a host has and what of it is in use, by whomever.
struct host_resources {
  std::string architecture;    ///< As container images name it: amd64, arm64.
  bool unified_memory = false; ///< CPU and GPU share one memory (Jetson).
  amount cpu;                  ///< In cores.
  /// `cpu.used` is the kernel's word on the load, for want of a sample.
  bool cpu_estimated = false;
  amount memory_mib;
  amount disk_mib; ///< Of the file system that holds the data directory.
  std::vector<gpu_resources> gpus;  ///< On unified memory with the index only.
  std::vector<std::string> devices; ///< Absolute paths below /dev.
};

struct host_probe_options {
  std::string root;     ///< Put before /proc, /sys, /dev and /etc.
  std::string data_dir; ///< Need not exist yet.
  std::string nvml_library = "libnvidia-ml.so.1";
  /// How many cores this process may run on; 0 asks the kernel.
  unsigned affinity_cores = 0;
};

/// Reads the resources of the host that this process sees. Where a cgroup or
/// the CPU affinity gives the process less than the whole host, that is a bound
/// like one that the operator sets (`apply_bound`, host_probe_capacity.hpp).
///
/// CPU use is a rate between two samples. Nothing runs in between: the owner
/// marks samples. Where it has marked none in time, what the kernel says of the
/// load takes the rate's place, so that nobody waits for a second sample. Not
/// thread-safe.
class host_probe {
public:
  using clock = std::chrono::steady_clock;

  explicit host_probe(host_probe_options options);

  /// Remembers the CPU counters as of `now`. Samples that follow each other
  /// within 100 ms count as one; false where this one was not taken.
  bool sample(clock::time_point now);

  /// The cores in use since the newest sample that is at least
  /// `limits::resource::least_sample_age` old. None when there is no such
  /// sample, or only one older than `limits::resource::most_sample_age`.
  std::optional<double> cpu_used(clock::time_point now);

  /// The cores that programs have wanted over the last minute, or want at this
  /// moment, if that is more; not more than there are, and 0 where the kernel
  /// does not tell. Programs that wait for a disk count too.
  double load_estimate() const;

  /// Everything; `cpu.used` as by `cpu_used`, or else by `load_estimate`. GPU
  /// memory leaves out the processes of `own`.
  host_resources read(clock::time_point now, const std::set<pid_t>& own = {});

private:
  struct cpu_sample {
    clock::time_point at;
    double busy_seconds = 0; ///< Of all cores since the host started.
  };

  std::optional<double> busy_seconds() const;
  bool is_jetson() const;
  amount memory() const;
  amount disk() const;
  std::vector<std::string> devices() const;
  std::vector<gpu_resources> gpus(bool unified_memory,
                                  const std::set<pid_t>& own);

  host_probe_options options_;
  gpu_probe gpu_probe_;
  std::deque<cpu_sample> samples_; ///< Oldest first.
};

/// "x86_64" of `uname` is "amd64" to container images; unknown words stay.
std::string architecture_of(std::string_view machine);

} // namespace roscell
