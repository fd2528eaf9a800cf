#include "actors/edge/engine/image_cleaning.hpp"
#include "actors/edge/engine/image_reference.hpp"
#include "actors/instances/engine/engine_parts.hpp"
#include "messages/event_kinds.hpp"

#include <set>
#include <utility>

namespace roscell {

namespace {

json document_of(const engine_answered& x) {
  return is_good(x) ? json::parse(x.body, nullptr, false) : json{};
}

/// What this node's instances name, and what is being built for them.
std::set<std::string> named_images(const engine_runtime_state& st) {
  std::set<std::string> result;
  for (const auto& [instance, image] : st.named)
    result.insert(image);
  for (const auto& [key, work] : st.works)
    result.insert(work.image);
  return result;
}

/// The engine refuses it if a container has come to have it meanwhile.
void remove_image(engine_runtime_pointer self, const std::string& name) {
  engine_request request;
  request.method = "DELETE";
  request.target = "/images/" + image_path(name);
  ask_engine(self, std::move(request), [=](const engine_answered& x) {
    if (is_good(x))
      self->state.config.context.publish_event(events::image_removed, name);
  });
}

void clean(engine_runtime_pointer self, const json& images,
           const engine_answered& containers) {
  const auto& st = self->state;
  if (!is_good(containers))
    return;
  for (const auto& name : images_to_remove(
           built_images_in(images), used_images_in(document_of(containers)),
           named_images(st), st.config.kept_images))
    remove_image(self, name);
}

} // namespace

void clean_images(engine_runtime_pointer self) {
  engine_request images;
  images.target = "/images/json";
  ask_engine(self, std::move(images), [=](const engine_answered& x) {
    const auto list = document_of(x);
    if (built_images_in(list).size() <= self->state.config.kept_images)
      return;
    engine_request containers;
    containers.target = "/containers/json?all=1";
    ask_engine(self, std::move(containers),
               [=](const engine_answered& y) { clean(self, list, y); });
  });
}

} // namespace roscell
