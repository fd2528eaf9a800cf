#include "tools/roscell/dashboard/open_page.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/child_setup.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

bool has_desktop() {
  return std::getenv("DISPLAY") != nullptr
         || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

/// A page that leads on to the address; empty if none can be made. A browser in
/// a sandbox reads what is seen in the home folder, but neither hidden files
/// nor the folder of the desktop's session.
fs::path make_signpost(const std::string& url) {
  constexpr std::string_view ending = ".html";
  const char* home = std::getenv("HOME");
  if (home == nullptr)
    return {};
  auto file = (fs::path{home} / "roscell-dashboard-XXXXXX").string();
  file += ending;
  // Of a new file nobody else can read a byte.
  const unique_fd fd{
      mkostemps(file.data(), static_cast<int>(ending.size()), O_CLOEXEC)};
  if (!fd)
    return {};
  const auto text =
      "<!doctype html><meta http-equiv=\"refresh\" content=\"0; url=" + url
      + "\"><title>ROSCell</title>\n";
  if (write(fd.get(), text.data(), text.size())
      == static_cast<ssize_t>(text.size()))
    return file;
  unlink(file.c_str());
  return {};
}

/// Nobody waits for its end: it may become the browser itself.
bool start_browser(const fs::path& page) {
  child_setup setup;
  setup.read_nothing();
  setup.leave_terminal();
  std::string name = "xdg-open";
  auto file = page.string();
  const std::array<char*, 3> arguments{name.data(), file.data(), nullptr};
  pid_t child = 0;
  return posix_spawnp(&child, name.c_str(), &setup.files, &setup.attributes,
                      arguments.data(), environ)
         == 0;
}

} // namespace

opened_page::opened_page(const std::string& url) {
  if (!has_desktop())
    return;
  signpost_ = make_signpost(url);
  begun_ = !signpost_.empty() && start_browser(signpost_);
}

opened_page::~opened_page() {
  std::error_code ignored;
  if (!signpost_.empty())
    fs::remove(signpost_, ignored);
}

} // namespace roscell::cli
