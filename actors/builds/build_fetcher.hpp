#pragma once

#include "actors/builds/fetch_table.hpp"
#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// One question to another node, answered by `source_answered`.
struct source_question {
  uint64_t number = 0;
  build_source source;
  std::string target; ///< Path and query.
  std::chrono::milliseconds timeout{0};
};

struct build_fetcher_config {
  actor_context context;
  std::string node; ///< The name of this one.
  build_keeper_actor keeper;
  /// Asks another node; must not block.
  std::function<void(const build_fetcher_actor&, const source_question&)> ask;
};

/// A build that is on its way here.
struct running_fetch {
  fetch_build order;
  std::vector<caf::typed_response_promise<build_fetched>> promises;
  std::optional<fetch_table> table; ///< Once its manifest is here.
  size_t asked_for_manifest = 0;    ///< Sources so far, in their order.
  std::string last_problem;         ///< Of a source that gave no manifest.
  int64_t began_unix_ms = 0;
  /// Not before is it told how it gets on.
  std::chrono::steady_clock::time_point next_progress;
};

/// What was asked, by the number of the question.
struct asked_source {
  enum class kind { manifest, pieces_there, piece };

  std::string hash;
  std::string source; ///< A node's name.
  kind what = kind::manifest;
  size_t piece = 0;
  int64_t beyond = -1; ///< More pieces than that are waited for.
  std::chrono::steady_clock::time_point at;
};

/// Owns all fetches of this node. Steps can be interrupted by the end of a
/// fetch: each begins by asking whether it still runs.
struct build_fetcher_state {
  static constexpr const char* name = "build-fetcher";

  build_fetcher_config config;
  std::map<std::string, running_fetch> fetches; ///< By hash.
  std::map<uint64_t, asked_source> questions;
  uint64_t last_question = 0;
  alarm timer; ///< For pieces that have become slow.
};

/// The BUILD FETCHER. Messages: messages/inside/builds.hpp.
build_fetcher_actor::behavior_type
build_fetcher(build_fetcher_actor::stateful_pointer<build_fetcher_state> self,
              const build_fetcher_config& config);

} // namespace roscell
