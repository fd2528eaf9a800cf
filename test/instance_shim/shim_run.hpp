#pragma once

#include "test/skills/child_process.hpp"

#include "test/places.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

/// The instance shim with a shell script as its command.
namespace roscell::test {

using nlohmann::json;

inline const std::string shim = test::build_dir() / "bin/roscell-instance-shim";

/// What the shim in that folder says of its processes.
inline std::string record_of_processes(const std::string& dir) {
  std::error_code error;
  return std::filesystem::read_symlink(dir + "/pid", error).string();
}

/// Runs a shell script under the shim, with its records in `dir`.
struct shim_run {
  explicit shim_run(const std::string& script, std::size_t log_bytes = 65536,
                    std::optional<std::size_t> limit_file_bytes = {},
                    const std::vector<std::string>& options = {})
      : process(command(script, log_bytes, options),
                {{"PATH", "/usr/bin:/bin"}}, limit_file_bytes) {
    // nop
  }

  std::vector<std::string>
  command(const std::string& script, std::size_t log_bytes,
          const std::vector<std::string>& options) const {
    std::vector<std::string> result{shim, "--dir", dir(), "--log-bytes",
                                    std::to_string(log_bytes)};
    result.insert(result.end(), options.begin(), options.end());
    result.insert(result.end(), {"--", "/bin/sh", "-c", script});
    return result;
  }

  std::string dir() const {
    return folder / "instance";
  }

  /// Waits for a file of the instance.
  bool wait_for(const std::string& name) {
    auto there = [&](const std::string& path) {
      return std::filesystem::exists(std::filesystem::symlink_status(path));
    };
    return wait_in_folder(folder / "", [&] { return there(dir() + "/."); })
           && wait_in_folder(dir(), [&] { return there(dir() + "/" + name); });
  }

  bool wait_for_log(const std::string& part) {
    return wait_in_folder(dir(), [&] {
      return content_of(dir() + "/log.0").find(part) != std::string::npos;
    });
  }

  json exit() const {
    return json::parse(content_of(dir() + "/exit"), nullptr, false);
  }

  /// The numbers in `pid`: shim, start time, child.
  std::vector<unsigned long> pids() const {
    std::istringstream text{record_of_processes(dir())};
    std::vector<unsigned long> result(3);
    text >> result[0] >> result[1] >> result[2];
    return result;
  }

  /// Offsets of the log files, in order.
  std::vector<std::size_t> log_offsets() const {
    std::vector<std::size_t> result;
    for (const auto& name : names_in(dir()))
      if (name.compare(0, 4, "log.") == 0)
        result.push_back(std::stoul(name.substr(4)));
    std::sort(result.begin(), result.end());
    return result;
  }

  std::string log(std::size_t offset) const {
    return content_of(dir() + "/log." + std::to_string(offset));
  }

  /// Offsets and times of what stands in a log file.
  std::vector<std::pair<std::int64_t, std::int64_t>>
  times(std::size_t offset) const {
    const auto bytes = content_of(dir() + "/times." + std::to_string(offset));
    std::vector<std::pair<std::int64_t, std::int64_t>> result;
    for (std::size_t at = 0; at + 16 <= bytes.size(); at += 16) {
      std::int64_t note[2];
      std::memcpy(note, bytes.data() + at, sizeof(note));
      result.emplace_back(note[0], note[1]);
    }
    return result;
  }

  temp_folder folder;
  child_process process;
};

} // namespace roscell::test
