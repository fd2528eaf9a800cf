#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/disk/secret_folder.hpp"
#include "actors/edge/process/memory_folder.hpp"
#include "actors/instances/secrets/secret_names.hpp"
#include "actors/instances/secrets/secret_table.hpp"
#include "messages/messages.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace roscell {

struct secret_keeper_config {
  actor_context context;
  std::string node;             ///< The node's name.
  std::filesystem::path folder; ///< In the node's data directory.
  /// Where the files of instances go, the best first, and what the node's own
  /// folder there is called.
  std::vector<std::filesystem::path> places;
  std::string place_name;
  /// What instances that may still run have been given by an earlier run of the
  /// node. The files of all others go.
  std::map<std::string, std::set<std::string>> given;
  shared_secret_names names; ///< Told which there are.
};

/// Owns the secrets of this node: their files in its data directory, and those
/// in memory that instances read. Spawned as one that blocks: it reads and
/// writes them. It keeps no value.
struct secret_keeper_state {
  static constexpr const char* name = "secret-keeper";

  secret_keeper_config config;
  std::optional<secret_folder> disk;
  std::optional<memory_folder> memory;
  secret_table table;
};

/// The SECRET KEEPER. Messages: messages/secret.hpp.
secret_keeper_actor::behavior_type
secret_keeper(secret_keeper_actor::stateful_pointer<secret_keeper_state> self,
              const secret_keeper_config& config);

/// What the node's own folder in memory is called: the same at each start in
/// that data directory, and another for another one.
std::string place_name_of(const std::filesystem::path& data_dir);

/// All that a specification names, as files or as variables.
std::set<std::string> secrets_of(const instance_spec& spec);

} // namespace roscell
