#include "tools/roscell/dashboard/open_page.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

/// A folder that only this user can look into; empty if there is none.
fs::path own_folder() {
  const char* folder = std::getenv("XDG_RUNTIME_DIR");
  return folder == nullptr ? fs::path{} : fs::path{folder};
}

bool has_desktop() {
  return std::getenv("DISPLAY") != nullptr
         || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

/// A page that leads on to the address.
bool write_signpost(const fs::path& file, const std::string& url) {
  std::ofstream out{file};
  out << "<!doctype html><meta http-equiv=\"refresh\" content=\"0; url=" << url
      << "\"><title>ROSCell</title>\n";
  out.close();
  std::error_code failed;
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write, failed);
  return out.good() && !failed;
}

} // namespace

bool open_page(const std::string& url) {
  const auto folder = own_folder();
  if (folder.empty() || !has_desktop())
    return false;
  const auto file = folder / "roscell-dashboard.html";
  if (!write_signpost(file, url))
    return false;
  const auto child = fork();
  if (child == 0) {
    execlp("xdg-open", "xdg-open", file.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status)
         && WEXITSTATUS(status) == 0;
}

} // namespace roscell::cli
