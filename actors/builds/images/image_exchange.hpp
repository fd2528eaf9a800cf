#pragma once

#include "actors/core/actor_context.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

struct image_exchange_config {
  actor_context context;
  std::string node;             ///< The name of this one.
  std::string architecture;     ///< Of this host.
  std::filesystem::path builds; ///< The keeper's folder.
  uint64_t most_bytes = 0;      ///< Of one image.
  /// Makes one that asks this node's engine.
  std::function<image_worker_actor(const image_exchange_actor&)> make_worker;
  /// Ends what they wait for, so that none holds up the end of the node.
  std::function<void()> stop_workers;
};

/// An image on its way to this node's engine.
struct image_arrival {
  std::vector<caf::typed_response_promise<image_brought>> promises;
  std::vector<std::string> layers; ///< That the engine has.
  image_offered offer;
  int attempts = 0; ///< So far.
  int64_t began_unix_ms = 0;
};

/// An image that this node's engine saves for others.
struct image_departure {
  std::vector<caf::typed_response_promise<image_shared>> promises;
  image_sharing request;
  int64_t began_unix_ms = 0;
};

/// Owns the ways of images between this node's engine and the node's builds.
/// Steps can be interrupted by the end of what they are for: each begins by
/// asking whether it is still under way.
struct image_exchange_state {
  static constexpr const char* name = "image-exchange";

  image_exchange_config config;
  serve_images parts;        ///< Invalid while the node starts.
  image_worker_actor looker; ///< Answers at once; null: not needed so far.
  image_worker_actor mover;  ///< Saves and loads, one after the other.
  std::map<std::string, image_arrival> arrivals;     ///< By the image's name.
  std::map<std::string, image_departure> departures; ///< By id and layers.
  /// What earlier departures have become; the newest come last.
  std::deque<std::pair<std::string, build_name>> shared;
};

/// The IMAGE EXCHANGE. Messages: messages/inside/images.hpp.
image_exchange_actor::behavior_type image_exchange(
    image_exchange_actor::stateful_pointer<image_exchange_state> self,
    const image_exchange_config& config);

// INTERNAL to the image exchange.

using image_exchange_pointer =
    image_exchange_actor::stateful_pointer<image_exchange_state>;

/// Of an actor that may not be there yet, or not any more.
const image_worker_actor& worker_of(image_exchange_pointer self,
                                    image_worker_actor& which);

/// Gives an image of this node's engine to others: image_departures.cpp.
caf::result<image_shared> share_image(image_exchange_pointer self,
                                      const image_sharing& request);

} // namespace roscell
