#pragma once

#include "actors/edge/http/client/http_client.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// What an engine knows of its images, asked by who can wait for it.
namespace roscell {

/// Where an engine is asked.
struct engine_door {
  std::string socket;
  std::string api; ///< "1.41"; empty: whatever the engine itself takes.
  /// Its load takes archives in which layers are left out that it has: Docker
  /// looks for them by their chain ids before it opens their files.
  bool leaves_out_layers = false;
  /// Ends what waits for the engine, when the node ends; null: nothing does.
  std::shared_ptr<const http_cancel> cancel;
};

/// How long a question to the engine may take.
http_client::options within(const engine_door& door,
                            std::chrono::milliseconds limit);

/// A path of the engine's API, with its version.
std::string api_path(const engine_door& door, const std::string& path);

/// Asks the engine, and waits. The reply is good; what it refuses is
/// `engine_failed`, in its words.
edge_result<http_reply> ask_engine_now(const engine_door& door,
                                       const std::string& method,
                                       const std::string& path,
                                       const std::string& what);

struct engine_image {
  std::string id;
  std::string architecture;
  int64_t bytes = 0;
  std::vector<std::string> layers; ///< Diff ids, from the bottom.
};

/// Nothing: the engine knows no image of that name. Errors: engine_failed and
/// those of an engine that does not answer.
edge_result<std::optional<engine_image>>
inspect_image(const engine_door& door, const std::string& image);

/// The chain ids of all layers of the images that were made last. The same
/// errors.
edge_result<std::vector<std::string>> list_chains(const engine_door& door);

} // namespace roscell
