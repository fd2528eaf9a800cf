#include "actors/edge/host/boot_id.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/process/process_identity.hpp"

#include <cctype>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// More than a UUID and the end of its line.
constexpr size_t most_bytes = 64;

bool is_of_id(unsigned char c) {
  return std::isalnum(c) != 0 || c == '-';
}

} // namespace

std::string this_boot(const fs::path& proc) {
  auto id = read_small_file(proc / "sys/kernel/random/boot_id", most_bytes);
  const auto first = identify(1, proc);
  if (!id || !first)
    return {};
  size_t end = 0;
  while (end < id->size() && is_of_id((*id)[end]))
    ++end;
  if (end == 0)
    return {};
  return id->substr(0, end) + '/' + std::to_string(first->start_time);
}

} // namespace roscell
