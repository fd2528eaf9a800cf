#include "actors/edge/host/installed_files.hpp"

#include <algorithm>
#include <system_error>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr const char* shim_name = "roscell-instance-shim";

fs::path private_folder(const fs::path& bin) {
  return bin.parent_path() / "lib" / "roscell";
}

} // namespace

fs::path program_folder() {
  std::error_code problem;
  return fs::read_symlink("/proc/self/exe", problem).parent_path();
}

fs::path find_shim(const fs::path& bin) {
  std::error_code problem;
  const auto beside = bin / shim_name;
  return fs::exists(beside, problem) ? beside : private_folder(bin) / shim_name;
}

fs::path installed_skills(const fs::path& bin) {
  return private_folder(bin) / "skills";
}

bool names_folder(const std::vector<fs::path>& folders,
                  const fs::path& folder) {
  return std::any_of(folders.begin(), folders.end(), [&](const auto& x) {
    std::error_code problem;
    return fs::equivalent(x, folder, problem);
  });
}

} // namespace roscell
