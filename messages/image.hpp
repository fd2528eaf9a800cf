#pragma once

#include "messages/build.hpp"
#include "messages/codec/json_codec.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// Container images that nodes pass on, because the engine of one of them lacks
/// what the engine of another one has. On its way an image is a build: the
/// folder that its engine saves it as.
namespace roscell {

/// A node asks its coordinator for an image that its engine lacks.
struct image_request {
  static constexpr const char* type = "image_request";
  std::string image; ///< As a skill names it: "debian:bookworm-slim".
  std::string architecture;
  std::string node; ///< The one that lacks it.
  /// Layers that its engine has and need not come: the chain id of each, which
  /// names it with all that are below it.
  std::vector<std::string> layers;

  static constexpr auto fields() {
    return field_list{required("image", &image_request::image),
                      required("architecture", &image_request::architecture),
                      required("node", &image_request::node),
                      optional("layers", &image_request::layers)};
  }
};

struct image_offered {
  static constexpr const char* type = "image_offered";
  std::string image_id; ///< "sha256:..."; what is loaded must be that.
  std::string node;     ///< The one whose engine has it.
  std::string cell;
  build_offer offer;

  static constexpr auto fields() {
    return field_list{required("image_id", &image_offered::image_id),
                      required("node", &image_offered::node),
                      required("cell", &image_offered::cell),
                      required("offer", &image_offered::offer)};
  }
};

/// Asks a node whether its engine knows an image.
struct image_query {
  static constexpr const char* type = "image_query";
  std::string image;
  std::string architecture;

  static constexpr auto fields() {
    return field_list{required("image", &image_query::image),
                      required("architecture", &image_query::architecture)};
  }
};

struct image_known {
  static constexpr const char* type = "image_known";
  std::string image_id; ///< Empty: it does not.
  int64_t bytes = 0;

  static constexpr auto fields() {
    return field_list{optional("image_id", &image_known::image_id),
                      optional("bytes", &image_known::bytes)};
  }
};

/// Has a node make a build of an image that its engine knows, for others.
struct image_sharing {
  static constexpr const char* type = "image_sharing";
  std::string image_id;
  std::string cell;                ///< For which it is.
  std::vector<std::string> layers; ///< As in `image_request`: may be left out.

  static constexpr auto fields() {
    return field_list{required("image_id", &image_sharing::image_id),
                      required("cell", &image_sharing::cell),
                      optional("layers", &image_sharing::layers)};
  }
};

struct image_shared {
  static constexpr const char* type = "image_shared";
  build_name build;

  static constexpr auto fields() {
    return field_list{required("build", &image_shared::build)};
  }
};

} // namespace roscell
