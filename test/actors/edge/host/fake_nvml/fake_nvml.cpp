#include <cstdio>
#include <cstring>

/// A stand-in for NVIDIA's libnvidia-ml.so.1 with three GPUs, of which the
/// second does not answer. The interface is NVML's.
namespace {

struct memory {
  unsigned long long total;
  unsigned long long free;
  unsigned long long used;
};

struct process {
  unsigned pid;
  unsigned long long used;
  unsigned gpu_instance;
  unsigned compute_instance;
};

constexpr unsigned long long mib = 1024ULL * 1024ULL;
constexpr int success = 0;
constexpr int uninitialized = 1;
constexpr int gpu_is_lost = 15;

bool started = false;
int devices[3] = {0, 1, 2};

} // namespace

extern "C" {

int nvmlInit_v2() {
  started = true;
  return success;
}

int nvmlShutdown() {
  started = false;
  return success;
}

int nvmlDeviceGetCount_v2(unsigned* count) {
  *count = 3;
  return started ? success : uninitialized;
}

int nvmlDeviceGetHandleByIndex_v2(unsigned index, void** device) {
  if (index == 1)
    return gpu_is_lost;
  *device = &devices[index];
  return success;
}

int nvmlDeviceGetName(void* device, char* name, unsigned length) {
  std::snprintf(name, length, "Fake GPU %d", *static_cast<int*>(device));
  return success;
}

int nvmlDeviceGetMemoryInfo(void* device, memory* info) {
  auto index = static_cast<unsigned>(*static_cast<int*>(device));
  info->total = (8192 + index) * mib;
  info->used = (1024 + index) * mib;
  info->free = info->total - info->used;
  return success;
}

/// On the first GPU: one process that computes and draws, one that computes,
/// and one whose use the driver does not know.
int nvmlDeviceGetComputeRunningProcesses_v3(void* device, unsigned* count,
                                            process* list) {
  if (device != &devices[0]) {
    *count = 0;
    return success;
  }
  if (*count < 3)
    return 7; // insufficient size
  list[0] = {4242, 500 * mib, 0, 0};
  list[1] = {4243, 200 * mib, 0, 0};
  list[2] = {4244, ~0ULL, 0, 0};
  *count = 3;
  return success;
}

int nvmlDeviceGetGraphicsRunningProcesses_v3(void* device, unsigned* count,
                                             process* list) {
  *count = device == &devices[0] ? 1 : 0;
  list[0] = {4242, 500 * mib, 0, 0};
  return success;
}

} // extern "C"
