#include "tools/roscell/shell/editing/history_file.hpp"

#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

constexpr mode_t users_own = 0600;

/// Each in its line.
std::string history_text(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& x : lines)
    text += x + "\n";
  return text;
}

/// In one write, so that the lines of two shells do not mix. Returns whether
/// all of it is there.
bool write_history(const fs::path& file, int flags, const std::string& text) {
  const unique_fd fd{
      open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | flags, users_own)};
  return fd
         && write(fd.get(), text.data(), text.size())
                == static_cast<ssize_t>(text.size());
}

std::string history_variable(const char* name) {
  const auto* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

} // namespace

history_file::history_file(fs::path file) : file_{std::move(file)} {
  std::ifstream in{file_};
  for (std::string line; std::getline(in, line);)
    if (!line.empty())
      lines_.push_back(line);
  if (lines_.size() <= most_lines)
    return;
  lines_.erase(lines_.begin(), lines_.end() - most_lines);
  shorten();
}

bool history_file::add(const std::string& line) {
  if (line.empty() || line.front() == ' ' || line.find('\n') != line.npos
      || (!lines_.empty() && lines_.back() == line))
    return false;
  lines_.push_back(line);
  if (file_.empty())
    return true;
  std::error_code ignored;
  if (!fs::exists(file_.parent_path(), ignored)
      && fs::create_directories(file_.parent_path(), ignored))
    fs::permissions(file_.parent_path(), fs::perms::owner_all, ignored);
  write_history(file_, O_APPEND, line + "\n");
  return true;
}

/// A file of its own takes the place of the old one, which is whole until then.
void history_file::shorten() const {
  auto next = file_;
  next += "." + std::to_string(getpid());
  std::error_code ignored;
  if (write_history(next, O_TRUNC, history_text(lines_)))
    fs::rename(next, file_, ignored);
  else
    fs::remove(next, ignored);
}

fs::path default_history() {
  if (auto state = history_variable("XDG_STATE_HOME"); !state.empty())
    return fs::path{state} / "roscell/history";
  if (auto home = history_variable("HOME"); !home.empty())
    return fs::path{home} / ".local/state/roscell/history";
  return {};
}

} // namespace roscell::cli
