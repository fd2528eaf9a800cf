#include "actors/instances/engine/image_packer.hpp"

#include "actors/house/edge_failure.hpp"
#include "actors/house/watching.hpp"
#include "actors/instances/engine/dockerfile.hpp"
#include "actors/instances/skill_folder.hpp"
#include "actors/instances/skill_program.hpp"
#include "messages/failure.hpp"

#include <caf/result.hpp>

#include <utility>
#include <variant>

namespace roscell {

namespace {

using image_packer_self =
    image_packer_actor::stateful_pointer<image_packer_state>;

/// What the base image may lack of what the skill's own program needs.
edge_result<std::vector<shared_library>>
libraries_for(const prepare_image& wish) {
  if (wish.entry_point.empty())
    return std::vector<shared_library>{};
  const auto program = find_program(wish.skill_dir, wish.entry_point);
  if (const auto* error = std::get_if<edge_error>(&program))
    return *error;
  return find_libraries(wish.skill_dir,
                        std::get<std::filesystem::path>(program));
}

caf::result<image_planned> plan(image_packer_self self,
                                const prepare_image& wish) {
  auto libraries = libraries_for(wish);
  if (const auto* error = std::get_if<edge_error>(&libraries))
    return to_caf(*error);
  image_recipe recipe{
      wish.operation, wish.skill, wish.base_image, wish.entry_point,
      std::get<std::vector<shared_library>>(std::move(libraries))};
  auto& content = self->state.content;
  content.dockerfile = dockerfile_of(recipe);
  content.skill_dir = wish.skill_dir;
  content.libraries = std::move(recipe.libraries);
  self->state.wish = wish;
  return image_planned{image_name(wish.operation, content.dockerfile),
                       content.dockerfile};
}

caf::result<image_packed> pack(image_packer_self self) {
  const auto& st = self->state;
  if (st.content.dockerfile.empty())
    return fail(error_code::conflict, "no image has been planned");
  const auto file = write_build_context(st.content, st.work_dir);
  if (const auto* error = std::get_if<edge_error>(&file))
    return to_caf(*error);
  const auto& packed = std::get<std::filesystem::path>(file);
  // Afterwards: an edit in the middle of it is seen, too.
  const auto same = check_build(st.wish);
  if (const auto* error = std::get_if<edge_error>(&same)) {
    std::error_code ignored;
    std::filesystem::remove(packed, ignored);
    return to_caf(*error);
  }
  return image_packed{packed.string()};
}

} // namespace

image_packer_actor::behavior_type
image_packer(image_packer_self self, const std::filesystem::path& work_dir,
             const engine_runtime_actor& owner) {
  self->state.work_dir = work_dir;
  watch_until_own_end(self, owner);
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  return {
      [self](const state_query&) {
        return state_of({{"skill", self->state.content.skill_dir.string()}});
      },
      [self](const prepare_image& x) { return plan(self, x); },
      [self](const pack_image&) { return pack(self); },
  };
}

} // namespace roscell
