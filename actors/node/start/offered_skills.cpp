#include "actors/node/start/offered_skills.hpp"

#include "actors/edge/host/installed_files.hpp"
#include "messages/failure.hpp"

#include <filesystem>
#include <memory>
#include <utility>

namespace roscell {

caf::expected<shared_skill_catalogue>
offered_skills(const node_config& config, const chosen_runtime& runtime,
               const std::vector<std::string>& actor_skills) {
  auto dirs = config.skill_dirs;
  // The usual places need not be there; those that were named must be.
  for (auto& usual :
       {installed_skills(program_folder()), config.data_dir / "skills"})
    if (is_directory(usual) && !names_folder(dirs, usual))
      dirs.push_back(usual);
  const skill_host host{own_architecture(), runtime.socket.empty()};
  auto result =
      std::make_shared<skill_catalogue>(skill_catalogue::scan(dirs, host));
  for (const auto& text : actor_skills)
    if (const auto errors = result->add_actor_skill(text); !errors.empty())
      return fail(error_code::schema_violation,
                  "the descriptor of an actor skill: " + errors[0].expected,
                  errors[0].pointer);
  return shared_skill_catalogue{std::move(result)};
}

} // namespace roscell
