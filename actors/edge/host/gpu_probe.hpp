#pragma once

#include "messages/resources.hpp"

#include <memory>
#include <set>
#include <string>
#include <vector>

#include <sys/types.h>

namespace roscell {

/// Asks NVIDIA's management library for the GPUs of this host. The library is
/// opened when first asked, as a host without it is the normal case, and stays
/// open then: without a persistence daemon the driver takes seconds to start.
class gpu_probe {
public:
  /// `library` is a name for `dlopen`.
  explicit gpu_probe(std::string library = "libnvidia-ml.so.1");
  ~gpu_probe();

  gpu_probe(const gpu_probe&) = delete;
  gpu_probe& operator=(const gpu_probe&) = delete;

  /// The GPUs by index; memory in MiB. What anybody uses of it counts as used,
  /// but for the processes of `own`, as far as the driver tells of them. None
  /// without the library or its driver, which is no error. A GPU that does not
  /// answer is left out.
  std::vector<gpu_resources> read(const std::set<pid_t>& own = {});

private:
  class nvml;
  std::string library_;
  std::unique_ptr<nvml> nvml_;
};

} // namespace roscell
