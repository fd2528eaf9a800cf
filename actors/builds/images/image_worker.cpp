#include "actors/builds/images/image_worker.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/core/watching.hpp"
#include "actors/edge/engine/image_reference.hpp"
#include "actors/edge/engine/image_transfer.hpp"
#include "messages/failure.hpp"

#include <caf/result.hpp>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

using image_worker_self =
    image_worker_actor::stateful_pointer<image_worker_state>;

/// A folder that is gone with this.
class passing_folder {
public:
  explicit passing_folder(const fs::path& parent) {
    std::error_code error;
    fs::create_directories(parent, error);
    std::string name = parent / "work-XXXXXX";
    if (::mkdtemp(name.data()) != nullptr)
      path_ = name;
    else
      problem_ = std::strerror(errno);
  }

  ~passing_folder() {
    std::error_code ignored;
    if (!path_.empty())
      fs::remove_all(path_, ignored);
  }

  passing_folder(const passing_folder&) = delete;
  passing_folder& operator=(const passing_folder&) = delete;

  const fs::path& path() const {
    return path_;
  }

  const std::string& problem() const {
    return problem_;
  }

private:
  fs::path path_;
  std::string problem_;
};

caf::error no_folder(image_worker_self self, const std::string& why) {
  return fail(error_code::internal, "cannot make a folder in '"
                                        + self->state.config.work_dir.string()
                                        + "': " + why);
}

/// One of another architecture is none for who asks.
caf::result<image_known> look_up(image_worker_self self,
                                 const image_query& query) {
  const auto found =
      inspect_image(self->state.config.door, name_in_engine(query.image));
  if (const auto* why = std::get_if<edge_error>(&found))
    return to_caf(*why);
  const auto& image = std::get<std::optional<engine_image>>(found);
  if (image && image->architecture == query.architecture)
    return image_known{image->id, image->bytes};
  return image_known{};
}

/// The engine that has pulled an image knows it by its digest.
caf::result<image_known> look_up_both(image_worker_self self,
                                      const image_query& query) {
  if (name_in_engine(query.image) == query.image)
    return look_up(self, query);
  const auto pulled = inspect_image(self->state.config.door, query.image);
  if (const auto* found = std::get_if<std::optional<engine_image>>(&pulled))
    if (*found && (*found)->architecture == query.architecture)
      return image_known{(*found)->id, (*found)->bytes};
  return look_up(self, query);
}

caf::result<layers_listed> list(image_worker_self self) {
  auto chains = list_chains(self->state.config.door);
  if (const auto* why = std::get_if<edge_error>(&chains))
    return to_caf(*why);
  return layers_listed{std::get<std::vector<std::string>>(std::move(chains))};
}

caf::result<image_saved> save(image_worker_self self, const save_image& x) {
  const auto& config = self->state.config;
  const passing_folder work{config.work_dir};
  if (work.path().empty())
    return no_folder(self, work.problem());
  auto saved =
      save_image_of(config.door, {x.image_id, x.layers, work.path(),
                                  static_cast<uint64_t>(x.most_bytes)});
  if (const auto* why = std::get_if<edge_error>(&saved))
    return to_caf(*why);
  auto& image = std::get<image_in_folder>(saved);
  const auto place = config.work_dir / image.build.name.hash;
  std::error_code error;
  fs::remove_all(place, error);
  fs::rename(image.folder, place, error);
  if (error)
    return no_folder(self, error.message());
  return image_saved{image.build.name, std::move(image.build.text),
                     place.string()};
}

caf::result<image_loaded> load(image_worker_self self, const load_image& x) {
  const auto& config = self->state.config;
  const passing_folder work{config.work_dir};
  if (work.path().empty())
    return no_folder(self, work.problem());
  if (const auto why = load_image_of(
          config.door, {x.image_id, x.image, x.folder, work.path()}))
    return to_caf(*why);
  return image_loaded{};
}

} // namespace

image_worker_actor::behavior_type
image_worker(image_worker_self self, const image_worker_config& config,
             const image_exchange_actor& owner) {
  self->state.config = config;
  watch_until_own_end(self, owner);
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  return {
      [self](const state_query&) {
        return state_of({{"engine", self->state.config.door.socket}});
      },
      [self](const image_query& x) { return look_up_both(self, x); },
      [self](const list_layers&) { return list(self); },
      [self](const save_image& x) { return save(self, x); },
      [self](const load_image& x) { return load(self, x); },
  };
}

} // namespace roscell
