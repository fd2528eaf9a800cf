#pragma once

#include "tools/roscell/doctor/check.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// What of NVIDIA is there. A GPU needs all of it: the card, the kernel's
/// module, its device files, and the library of the same version.
struct gpu_readings {
  bool card = false;                ///< On the PCI bus.
  std::string module;               ///< Version of the module; empty: none.
  std::vector<std::string> devices; ///< "/dev/nvidia0", ...
  std::string unusable_device;      ///< The first that this user cannot open.
  std::string device_group;         ///< Its group; empty: root's.
  bool library = false;
  std::string library_error;     ///< Why it does not begin; empty: it does.
  std::vector<std::string> gpus; ///< "NVIDIA H100, 80 GiB".
};

gpu_readings read_gpu(const checked_host& host);

finding judge_gpu(const gpu_readings& gpu);

findings check_gpu(const checked_host& host);

} // namespace roscell::cli
