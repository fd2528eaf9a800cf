#include "tools/instance_shim/options.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace roscell::shim {

namespace {

/// A log shorter than this helps nobody; a longer one than a TiB is a typo.
constexpr std::uint64_t least_log_bytes = 1024;
constexpr std::uint64_t most_log_bytes = 1ULL << 40;

bool read_bytes(const char* text, std::uint64_t& result) {
  char* end = nullptr;
  if (*text < '0' || *text > '9')
    return false;
  result = std::strtoull(text, &end, 10);
  return *end == '\0' && result >= least_log_bytes && result <= most_log_bytes;
}

bool read_signal(const char* text, int& result) {
  constexpr long last_signal = 31;
  char* end = nullptr;
  const auto value = std::strtol(text, &end, 10);
  result = static_cast<int>(value);
  return end != text && *end == '\0' && value >= 1 && value <= last_signal;
}

bool usage() {
  ::dprintf(
      2, "usage: roscell-instance-shim {--dir DIR --log-bytes N | --exit FILE} "
         "[--fence FILE] [--cwd DIR] [--stop-signal S] -- COMMAND "
         "[ARGS...]\n"
         "N is a whole number of at least 1024, S one from 1 to 31.\n");
  return false;
}

} // namespace

bool read_options(int argc, char** argv, options& result) {
  auto i = 1;
  for (; i + 1 < argc && std::strcmp(argv[i], "--") != 0; i += 2) {
    const auto* value = argv[i + 1];
    if (std::strcmp(argv[i], "--dir") == 0)
      result.directory = value;
    else if (std::strcmp(argv[i], "--cwd") == 0)
      result.working_dir = value;
    else if (std::strcmp(argv[i], "--fence") == 0)
      result.fence = value;
    else if (std::strcmp(argv[i], "--exit") == 0)
      result.exit_file = value;
    else if (std::strcmp(argv[i], "--log-bytes") == 0
                 ? !read_bytes(value, result.log_bytes)
                 : std::strcmp(argv[i], "--stop-signal") != 0
                       || !read_signal(value, result.stop_signal))
      return usage();
  }
  result.command = argv + i + 1;
  const auto logs = result.directory != nullptr && result.log_bytes > 0
                    && result.exit_file == nullptr;
  const auto only_records = result.directory == nullptr && result.log_bytes == 0
                            && result.exit_file != nullptr;
  const auto has_command = i + 1 < argc && std::strcmp(argv[i], "--") == 0;
  return ((logs || only_records) && has_command) || usage();
}

} // namespace roscell::shim
