#pragma once

#include "actors/builds/build_store.hpp"
#include "actors/core/actor_context.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace roscell {

struct build_keeper_config {
  actor_context context;
  std::filesystem::path folder; ///< In the node's data directory.
  uint64_t most_bytes = 0;      ///< Of all builds together.
  /// Knows what is in use, which never goes; invalid in tests where nothing is.
  container_supervisor_actor supervisor;
  std::string architecture; ///< Of this host.
};

/// Who asks what is here of a build, once there is more of it.
struct waiting_query {
  build_query query;
  std::chrono::steady_clock::time_point since;
  caf::typed_response_promise<build_held> promise;
};

/// Owns the builds on this node's disk. Spawned as one that blocks: it reads
/// and writes them.
struct build_keeper_state {
  static constexpr const char* name = "build-keeper";

  build_keeper_config config;
  std::unique_ptr<build_store> store;
  std::vector<waiting_query> waiting;
};

/// The BUILD KEEPER. Messages: messages/inside/builds.hpp.
build_keeper_actor::behavior_type
build_keeper(build_keeper_actor::stateful_pointer<build_keeper_state> self,
             const build_keeper_config& config);

} // namespace roscell
