#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <cstdint>
#include <filesystem>

namespace roscell {

/// How much an archive may hold.
struct archive_limits {
  size_t max_files = 10'000;
  uint64_t max_bytes = 16ULL << 30;
  /// Of what comes out for each byte of the archive, beyond the first of them:
  /// what is larger is no skill but a bomb.
  uint64_t max_ratio = 200;
  uint64_t free_bytes = 64ULL << 20;
};

/// Unpacks a tar (plain or compressed) or zip archive into an empty folder,
/// which holds nothing else and to which it is held: names that lead out,
/// absolute ones, links that lead out, hard links, devices, pipes and set-uid
/// bits are refused before anything of them is made. Gives the folder of the
/// skill in it: the one at the top, where all lies in one. What was unpacked
/// before an error stays; the folder is the caller's to remove.
///
/// Errors: schema_violation (it is no archive, or has what it may not have),
/// internal (the disk).
edge_result<std::filesystem::path>
unpack_skill(const std::filesystem::path& archive,
             const std::filesystem::path& into,
             const archive_limits& limits = {});

} // namespace roscell
