#pragma once

#include "skills/engine/file/file_reading.hpp"
#include "test/temp_folder.hpp"

#include <poll.h>
#include <sys/inotify.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// Files for the tests of skills and of the instance shim. Every wait is for
/// an event, and ends with a failure after `patience`.
namespace roscell::test {

using steady = std::chrono::steady_clock;

constexpr std::chrono::seconds patience{20};

/// The whole content, or an empty text if there is no such file.
inline std::string content_of(const std::string& path) {
  std::ostringstream result;
  result << std::ifstream{path, std::ios::binary}.rdbuf();
  return result.str();
}

/// The names in a folder, sorted.
inline std::vector<std::string> names_in(const std::string& path) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator{path})
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

/// Waits until `fd` is readable.
inline bool wait_readable(int fd, steady::time_point deadline = steady::now()
                                                                + patience) {
  using namespace std::chrono;
  pollfd waited{fd, POLLIN, 0};
  auto left = duration_cast<milliseconds>(deadline - steady::now()).count();
  auto limit_ms = static_cast<int>(std::max<std::int64_t>(left, 0));
  return ::poll(&waited, 1, limit_ms) == 1;
}

/// Waits until `done` is true, looking again at each change in the folder.
inline bool wait_in_folder(const std::string& folder,
                           const std::function<bool()>& done) {
  auto deadline = steady::now() + patience;
  engine::inotify_watch changes;
  changes.add(folder, IN_MODIFY | IN_CREATE | IN_MOVED_TO | IN_DELETE);
  while (!done()) {
    if (!wait_readable(changes.fd(), deadline))
      return false;
    changes.read();
  }
  return true;
}

} // namespace roscell::test
