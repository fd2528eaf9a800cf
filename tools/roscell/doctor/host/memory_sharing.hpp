#pragma once

#include "tools/roscell/doctor/checked_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

/// Whether the programs of this host that use Fast DDS's shared memory can. Two
/// that see the same network interfaces take each other for programs of one
/// host: they agree on shared memory by their discovery over UDP, and if one
/// cannot open what the other has made no data come, and no error either.
namespace roscell::cli {

/// A program that has memory of Fast DDS.
struct dds_program {
  int pid = 0;
  std::string name;
  uint32_t user = 0;
  std::string network;      ///< Its network namespace.
  std::string memory;       ///< Device of its /dev/shm.
  bool open_to_all = false; ///< Others may write to what it has made.
  std::set<int> domains;    ///< Of DDS.
};

struct dds_programs {
  std::vector<dds_program> all;
  size_t closed = 0; ///< Processes that this user may not look at.
};

dds_programs find_dds_programs(const std::filesystem::path& proc,
                               const std::filesystem::path& folder);

/// @param host_memory device of this host's own /dev/shm.
findings judge_memory_sharing(const dds_programs& programs,
                              const std::string& host_memory);

findings check_memory_sharing(const checked_host& host);

} // namespace roscell::cli
