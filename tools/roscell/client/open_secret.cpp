#include "tools/roscell/client/open_secret.hpp"

#include <system_error>

namespace roscell::cli {

namespace fs = std::filesystem;

std::string open_secret_warning(const fs::path& file) {
  std::error_code problem;
  const auto mode = fs::status(file, problem).permissions();
  if (problem || (mode & fs::perms::others_read) == fs::perms::none)
    return {};
  return "every user of this machine can read the token in " + file.string()
         + "; chmod 600 " + file.string();
}

} // namespace roscell::cli
