#include "actors/instances/engine/image_packer.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/core/watching.hpp"
#include "actors/edge/engine/build_context.hpp"
#include "actors/instances/skills/skill_program.hpp"
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
libraries_for(const prepare_image& request) {
  if (request.entry_point.empty())
    return std::vector<shared_library>{};
  const auto program = find_program(request.skill_dir, request.entry_point);
  if (const auto* error = std::get_if<edge_error>(&program))
    return *error;
  return find_libraries(request.skill_dir,
                        std::get<std::filesystem::path>(program));
}

/// What says which library of that name is loaded.
constexpr const char* linker_cache = "/etc/ld.so.cache";

/// Looked at before the libraries are: what changes while they are found is
/// taken for changed afterwards.
file_marks marks_before_search() {
  file_marks result;
  if (const auto mark = mark_of(linker_cache); !mark.empty())
    result[linker_cache] = mark;
  return result;
}

/// One that is not any more what was found makes the next plan a new one.
void add_marks(file_marks& marks,
               const std::vector<shared_library>& libraries) {
  for (const auto& x : libraries)
    marks[x.file.string()] = is_still(x) ? mark_of(x.file) : std::string{};
}

caf::result<image_planned> plan(image_packer_self self,
                                const prepare_image& request) {
  auto marks = marks_before_search();
  auto libraries = libraries_for(request);
  if (const auto* error = std::get_if<edge_error>(&libraries))
    return to_caf(*error);
  image_recipe recipe{
      request.operation, request.skill, request.base_image, request.entry_point,
      std::get<std::vector<shared_library>>(std::move(libraries))};
  auto& content = self->state.content;
  content.dockerfile = dockerfile_of(recipe);
  content.skill_dir = request.skill_dir;
  content.libraries = std::move(recipe.libraries);
  self->state.request = request;
  add_marks(marks, content.libraries);
  self->state.made_of = marks;
  return image_planned{image_name(request.operation, content.dockerfile),
                       content.dockerfile, std::move(marks)};
}

/// The image's own name tells of its base by that one's name, whichever way
/// this host's engine knows it.
image_content content_on(const image_packer_state& st,
                         const std::string& base) {
  auto result = st.content;
  if (!base.empty())
    result.dockerfile.replace(0, result.dockerfile.find('\n'), "FROM " + base);
  return result;
}

caf::result<image_packed> pack(image_packer_self self,
                               const std::string& base) {
  const auto& st = self->state;
  if (st.content.dockerfile.empty())
    return fail(error_code::conflict, "no image has been planned");
  const auto file = write_build_context(content_on(st, base), st.work_dir);
  if (const auto* error = std::get_if<edge_error>(&file))
    return to_caf(*error);
  const auto& packed = std::get<std::filesystem::path>(file);
  // Afterwards: an edit in the middle of it is seen, too.
  const auto same = check_build(st.request);
  const auto* error = std::get_if<edge_error>(&same);
  if (error == nullptr && are_unchanged(st.made_of))
    return image_packed{packed.string()};
  std::error_code ignored;
  std::filesystem::remove(packed, ignored);
  if (error != nullptr)
    return to_caf(*error);
  return fail(error_code::conflict,
              "libraries of this host have changed while the image was packed",
              {}, "start it again once they have been installed");
}

caf::result<login_found> find(image_packer_self self, const find_login& x) {
  auto header = find_login_header(x.image, self->state.logins);
  if (const auto* error = std::get_if<edge_error>(&header))
    return to_caf(*error);
  return login_found{std::get<std::string>(std::move(header))};
}

} // namespace

image_packer_actor::behavior_type
image_packer(image_packer_self self, const std::filesystem::path& work_dir,
             const login_places& logins, const engine_runtime_actor& owner) {
  self->state.work_dir = work_dir;
  self->state.logins = logins;
  watch_until_own_end(self, owner);
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  return {
      [self](const state_query&) {
        return state_of({{"skill", self->state.content.skill_dir.string()}});
      },
      [self](const prepare_image& x) { return plan(self, x); },
      [self](const pack_image& x) { return pack(self, x.base); },
      [self](const find_login& x) { return find(self, x); },
  };
}

} // namespace roscell
