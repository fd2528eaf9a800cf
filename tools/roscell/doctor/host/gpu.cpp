#include "tools/roscell/doctor/host/gpu.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/host/gpu_probe.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <dlfcn.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <system_error>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

constexpr size_t longest_driver_line = 4096;

bool has_card(const fs::path& buses) {
  std::error_code error;
  for (fs::directory_iterator i{buses, error}, end; !error && i != end;
       i.increment(error)) {
    const auto vendor = read_small_file(i->path() / "vendor", 16).value_or("");
    const auto kind = read_small_file(i->path() / "class", 16).value_or("");
    if (vendor.rfind("0x10de", 0) == 0 && kind.rfind("0x03", 0) == 0)
      return true;
  }
  return false;
}

/// The word with a point in "NVRM version: NVIDIA UNIX x86_64 Kernel Module
/// 535.129.03  Thu ...".
std::string module_version(const std::string& proc) {
  const auto text =
      read_small_file(proc + "/driver/nvidia/version", longest_driver_line)
          .value_or("");
  const auto digits = text.find_first_of("0123456789", text.find("Module"));
  return digits == text.npos
             ? text
             : text.substr(digits, text.find(' ', digits) - digits);
}

/// "/dev/nvidia0" and the like, not "/dev/nvidiactl".
std::vector<std::string> gpu_devices(const std::string& dev) {
  constexpr std::string_view prefix = "nvidia";
  std::vector<std::string> result;
  std::error_code error;
  for (fs::directory_iterator i{dev, error}, end; !error && i != end;
       i.increment(error)) {
    const auto name = i->path().filename().string();
    if (name.size() > prefix.size() && name.rfind(prefix, 0) == 0
        && name.find_first_not_of("0123456789", prefix.size()) == name.npos)
      result.push_back(i->path().string());
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Its name; empty for that of root, and for one that has none.
std::string group_of(const std::string& device) {
  struct stat info {};
  if (stat(device.c_str(), &info) != 0 || info.st_gid == 0)
    return {};
  constexpr size_t most_bytes = 16384;
  std::array<char, most_bytes> text{};
  group row{};
  group* found = nullptr;
  getgrgid_r(info.st_gid, &row, text.data(), text.size(), &found);
  return found == nullptr ? std::string{} : found->gr_name;
}

/// Who is in the group of root may do more than use a GPU.
std::string device_remedy(const gpu_readings& gpu) {
  if (!gpu.device_group.empty())
    return "sudo usermod -aG " + shell_word(gpu.device_group) + " "
           + own_user();
  const auto device = shell_word(gpu.unusable_device);
  return "sudo chmod a+rw " + device + "   # until the driver is loaded again";
}

/// Whether the library is there, and why it does not begin.
void ask_library(const std::string& name, gpu_readings& gpu) {
  const std::unique_ptr<void, int (*)(void*)> library{
      dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL),
      [](void* x) { return x == nullptr ? 0 : dlclose(x); }};
  gpu.library = library != nullptr;
  if (!gpu.library)
    return;
  const auto begin =
      reinterpret_cast<int (*)()>(dlsym(library.get(), "nvmlInit_v2"));
  const auto end =
      reinterpret_cast<int (*)()>(dlsym(library.get(), "nvmlShutdown"));
  const auto error_text = reinterpret_cast<const char* (*)(int)>(
      dlsym(library.get(), "nvmlErrorString"));
  if (begin == nullptr || end == nullptr) {
    gpu.library_error = "it is older than driver 319";
    return;
  }
  if (const auto code = begin(); code == 0)
    end();
  else
    gpu.library_error = error_text == nullptr ? "error " + std::to_string(code)
                                              : error_text(code);
}

} // namespace

gpu_readings read_gpu(const checked_host& host) {
  gpu_readings result;
  result.card = has_card(host.sys + "/bus/pci/devices");
  result.module = module_version(host.proc);
  result.devices = gpu_devices(host.dev);
  for (const auto& device : result.devices)
    if (result.unusable_device.empty()
        && access(device.c_str(), R_OK | W_OK) != 0) {
      result.unusable_device = device;
      result.device_group = group_of(device);
    }
  ask_library(host.nvml, result);
  if (result.library && result.library_error.empty())
    for (const auto& gpu : gpu_probe{host.nvml}.read())
      result.gpus.push_back(gpu.name + ", "
                            + format_memory(gpu.memory_mib.capacity));
  return result;
}

finding judge_gpu(const gpu_readings& gpu) {
  constexpr auto why =
      "this host offers no GPU, and steps that want one are placed elsewhere";
  const bool hardware = gpu.card || !gpu.devices.empty();
  if (!gpu.gpus.empty() && gpu.unusable_device.empty())
    return {judgement::ok,
            joined(gpu.gpus, "; ")
                + (gpu.module.empty() ? "" : ", driver " + gpu.module)};
  if (!hardware && gpu.module.empty())
    return {judgement::skipped, gpu.library
                                    ? "NVIDIA's library is there, but no GPU"
                                    : "there is no NVIDIA GPU"};
  if (gpu.module.empty() && gpu.devices.empty())
    return {judgement::warning, "there is a GPU, but its driver is not loaded",
            why, "sudo modprobe nvidia && sudo nvidia-modprobe -c 0 -u"};
  if (!gpu.unusable_device.empty())
    return {judgement::warning, "this user may not use " + gpu.unusable_device,
            why, device_remedy(gpu)};
  if (!gpu.library)
    return {judgement::warning,
            "there is a GPU with its driver, but no libnvidia-ml.so.1", why,
            "sudo apt-get install libnvidia-ml1"};
  if (!gpu.library_error.empty())
    return {judgement::broken,
            "NVIDIA's library does not begin: " + gpu.library_error
                + (gpu.module.empty() ? "" : " (module " + gpu.module + ")"),
            why,
            gpu.library_error.find("mismatch") != std::string::npos
                ? "sudo reboot   # loads the module that fits the library"
                : "nvidia-smi"};
  return {judgement::warning, "NVIDIA's library reports no GPU", why,
          "nvidia-smi"};
}

findings check_gpu(const checked_host& host) {
  return {judge_gpu(read_gpu(host))};
}

} // namespace roscell::cli
