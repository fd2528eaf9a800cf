#include "actors/edge/host/gpu_probe.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <dlfcn.h>

namespace roscell {

namespace {

/// The part of NVML's binary interface that we use (nvml.h, version 2 entry
/// points, unchanged since driver 319).
using nvml_device = void*;

struct nvml_memory {
  unsigned long long total = 0; ///< In bytes, as are the others.
  unsigned long long free = 0;
  unsigned long long used = 0;
};

/// One entry of a list of processes, version 2 and 3 (driver 510 and later).
struct nvml_process {
  unsigned pid = 0;
  unsigned long long used = 0; ///< In bytes; all ones: not known.
  unsigned gpu_instance = 0;
  unsigned compute_instance = 0;
};

constexpr unsigned long long nvml_unknown = ~0ULL;

constexpr int nvml_success = 0;

/// A longer list is not read, and its processes count as those of others.
constexpr unsigned max_processes = 256;

/// More than any machine has; bounds what a broken library can cost.
constexpr unsigned max_gpus = 64;

double to_mib(unsigned long long bytes) {
  return static_cast<double>(bytes) / (1024.0 * 1024.0);
}

} // namespace

class gpu_probe::nvml {
public:
  /// Null when the library, one of its functions or the driver is missing.
  static std::unique_ptr<nvml> open(const std::string& library) {
    std::unique_ptr<nvml> result{new nvml};
    result->handle_ = dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (result->handle_ == nullptr || !result->resolve()
        || result->init_() != nvml_success)
      return nullptr;
    result->started_ = true;
    return result;
  }

  ~nvml() {
    if (started_)
      shutdown_();
    if (handle_ != nullptr)
      dlclose(handle_);
  }

  nvml(const nvml&) = delete;
  nvml& operator=(const nvml&) = delete;

  std::vector<gpu_resources> read(const std::set<pid_t>& own) const {
    unsigned count = 0;
    std::vector<gpu_resources> result;
    if (get_count_(&count) != nvml_success)
      return result;
    for (unsigned i = 0; i < count && i < max_gpus; ++i) {
      gpu_resources gpu;
      if (read_one(i, own, gpu))
        result.push_back(std::move(gpu));
    }
    return result;
  }

private:
  nvml() = default;

  template <class Function>
  bool find(const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(handle_, name));
    return function != nullptr;
  }

  bool resolve() {
    // Older drivers do not tell of processes in this form.
    for (const char* name : {"nvmlDeviceGetComputeRunningProcesses_v3",
                             "nvmlDeviceGetComputeRunningProcesses_v2"})
      if (get_computing_ == nullptr)
        find(name, get_computing_);
    for (const char* name : {"nvmlDeviceGetGraphicsRunningProcesses_v3",
                             "nvmlDeviceGetGraphicsRunningProcesses_v2"})
      if (get_drawing_ == nullptr)
        find(name, get_drawing_);
    return find("nvmlInit_v2", init_) && find("nvmlShutdown", shutdown_)
           && find("nvmlDeviceGetCount_v2", get_count_)
           && find("nvmlDeviceGetHandleByIndex_v2", get_device_)
           && find("nvmlDeviceGetName", get_name_)
           && find("nvmlDeviceGetMemoryInfo", get_memory_);
  }

  using process_list = int (*)(nvml_device, unsigned*, nvml_process*);

  /// Bytes per process. One that computes and draws is in both lists, with the
  /// same use.
  static void read_processes(nvml_device device, process_list get,
                             std::map<pid_t, unsigned long long>& use) {
    std::array<nvml_process, max_processes> list{};
    auto count = max_processes;
    if (get == nullptr || get(device, &count, list.data()) != nvml_success)
      return;
    for (unsigned i = 0; i < std::min(count, max_processes); ++i)
      if (list[i].used != nvml_unknown) {
        auto& bytes = use[static_cast<pid_t>(list[i].pid)];
        bytes = std::max(bytes, list[i].used);
      }
  }

  /// What the processes of `own` use, in bytes.
  unsigned long long used_by(const std::set<pid_t>& own,
                             nvml_device device) const {
    if (own.empty())
      return 0;
    std::map<pid_t, unsigned long long> use;
    read_processes(device, get_computing_, use);
    read_processes(device, get_drawing_, use);
    unsigned long long sum = 0;
    for (const auto& [pid, bytes] : use)
      sum += own.count(pid) != 0 ? bytes : 0;
    return sum;
  }

  bool read_one(unsigned index, const std::set<pid_t>& own,
                gpu_resources& gpu) const {
    nvml_device device = nullptr;
    nvml_memory memory;
    std::array<char, 96> name{}; // NVML's own limit for names.
    if (get_device_(index, &device) != nvml_success
        || get_memory_(device, &memory) != nvml_success)
      return false;
    if (get_name_(device, name.data(), name.size() - 1) == nvml_success)
      gpu.name = name.data();
    gpu.index = static_cast<int>(index);
    gpu.memory_mib.capacity = to_mib(memory.total);
    gpu.memory_mib.used =
        to_mib(memory.used - std::min(memory.used, used_by(own, device)));
    return true;
  }

  void* handle_ = nullptr;
  bool started_ = false;
  int (*init_)() = nullptr;
  int (*shutdown_)() = nullptr;
  int (*get_count_)(unsigned*) = nullptr;
  int (*get_device_)(unsigned, nvml_device*) = nullptr;
  int (*get_name_)(nvml_device, char*, unsigned) = nullptr;
  int (*get_memory_)(nvml_device, nvml_memory*) = nullptr;
  process_list get_computing_ = nullptr;
  process_list get_drawing_ = nullptr;
};

gpu_probe::gpu_probe(std::string library) : library_(std::move(library)) {}

gpu_probe::~gpu_probe() = default;

std::vector<gpu_resources> gpu_probe::read(const std::set<pid_t>& own) {
  if (nvml_ == nullptr)
    nvml_ = nvml::open(library_);
  if (nvml_ == nullptr)
    return {};
  return nvml_->read(own);
}

} // namespace roscell
