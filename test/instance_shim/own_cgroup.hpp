#pragma once

#include "test/skills/files.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace roscell::test {

/// A real cgroup of version 1 below that of this process, in each hierarchy
/// that bounds something. Where none can be made there is none, and the test
/// says so.
class own_cgroup {
public:
  own_cgroup() {
    std::istringstream all{content_of("/proc/self/cgroup")};
    for (std::string line; std::getline(all, line);) {
      const auto first = line.find(':');
      const auto second = line.find(':', first + 1);
      const auto name = line.substr(first + 1, second - first - 1);
      if (name == "memory" || name == "freezer" || name == "pids"
          || name == "cpu" || name == "cpuacct")
        add("/sys/fs/cgroup/" + name + line.substr(second + 1));
    }
  }

  /// Whoever was killed there leaves it a moment later.
  ~own_cgroup() {
    constexpr auto attempts = 200;
    for (const auto& x : folders)
      for (auto i = 0; i < attempts && ::rmdir(x.c_str()) != 0; ++i)
        ::poll(nullptr, 0, 10);
  }

  own_cgroup(const own_cgroup&) = delete;
  own_cgroup& operator=(const own_cgroup&) = delete;

  bool has(const std::string& file) const {
    return !folder_with(file).empty();
  }

  void put(const std::string& file, const std::string& word) const {
    std::ofstream{folder_with(file) + "/" + file} << word;
  }

  std::string get(const std::string& file) const {
    return content_of(folder_with(file) + "/" + file);
  }

  std::vector<std::string> options() const {
    std::vector<std::string> result;
    for (const auto& x : folders)
      result.insert(result.end(), {"--cgroup", x});
    return result;
  }

  std::vector<std::string> folders;

private:
  void add(const std::string& parent) {
    const auto folder = parent + (parent.back() == '/' ? "" : "/")
                        + "roscell-test-" + std::to_string(::getpid());
    if (::mkdir(folder.c_str(), 0755) == 0)
      folders.push_back(folder);
  }

  std::string folder_with(const std::string& file) const {
    for (const auto& x : folders)
      if (::access((x + "/" + file).c_str(), F_OK) == 0)
        return x;
    return {};
  }
};

} // namespace roscell::test
