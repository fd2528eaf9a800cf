#pragma once

#include "messages/actors.hpp"
#include "messages/build.hpp"
#include "messages/image.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// What a node's actors say of container images that come from other nodes.
namespace roscell {

/// Gets an image that this node's engine lacks.
struct bring_image {
  std::string image;

  static constexpr auto fields() {
    return field_list{required("image", &bring_image::image)};
  }
};

/// The engine has it, under that name or, where that is a digest, by its id.
struct image_brought {
  std::string image_id;
  std::string node; ///< From which.
  int64_t bytes = 0;

  static constexpr auto fields() {
    return field_list{required("image_id", &image_brought::image_id),
                      required("node", &image_brought::node),
                      required("bytes", &image_brought::bytes)};
  }
};

/// Whom the image exchange works with.
struct serve_images {
  image_broker_actor broker; ///< Asks the cell.
  build_keeper_actor keeper;
  build_fetcher_actor fetcher;

  static constexpr auto fields() {
    return field_list{required("broker", &serve_images::broker),
                      required("keeper", &serve_images::keeper),
                      required("fetcher", &serve_images::fetcher)};
  }
};

/// Asks which layers the engine has and would not need to be given again.
struct list_layers {
  static constexpr auto fields() {
    return field_list{};
  }
};

struct layers_listed {
  std::vector<std::string> layers; ///< Chain ids.

  static constexpr auto fields() {
    return field_list{required("layers", &layers_listed::layers)};
  }
};

/// Has the engine save an image into a folder.
struct save_image {
  std::string image_id;
  std::vector<std::string> layers; ///< Chain ids of what is left out.
  int64_t most_bytes = 0;

  static constexpr auto fields() {
    return field_list{required("image_id", &save_image::image_id),
                      required("layers", &save_image::layers),
                      required("most_bytes", &save_image::most_bytes)};
  }
};

/// It is there; the folder is the receiver's.
struct image_saved {
  build_name name;
  std::string manifest; ///< Its text.
  std::string folder;

  static constexpr auto fields() {
    return field_list{required("name", &image_saved::name),
                      required("manifest", &image_saved::manifest),
                      required("folder", &image_saved::folder)};
  }
};

/// Has the engine load an image from a folder, and gives it its name.
struct load_image {
  std::string image_id; ///< What must be in it, and nothing else.
  std::string image;    ///< As a skill names it.
  std::string folder;

  static constexpr auto fields() {
    return field_list{required("image_id", &load_image::image_id),
                      required("image", &load_image::image),
                      required("folder", &load_image::folder)};
  }
};

struct image_loaded {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// A whole build lies in a folder beside the keeper's: it becomes one of its
/// builds, and the folder is gone.
struct take_build {
  build_name name;
  std::string manifest; ///< Its text.
  std::string cell;
  std::string folder;

  static constexpr auto fields() {
    return field_list{required("name", &take_build::name),
                      required("manifest", &take_build::manifest),
                      required("cell", &take_build::cell),
                      required("folder", &take_build::folder)};
  }
};

} // namespace roscell
