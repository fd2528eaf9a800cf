#include "actors/builds/stored_skill.hpp"

#include "actors/instances/skills/skill_catalogue.hpp"

#include <utility>
#include <variant>
#include <vector>

namespace roscell {

namespace {

/// Those that engines run containers for, as container images name them.
const std::vector<std::string>& known_architectures() {
  static const std::vector<std::string> result{
      "amd64", "arm64", "arm", "386", "riscv64", "ppc64le", "s390x"};
  return result;
}

/// Where its libraries are is the affair of who runs it.
skill_catalogue read_for(const std::filesystem::path& folder,
                         const std::string& architecture) {
  return skill_catalogue::of_folder(folder, {architecture, false});
}

} // namespace

edge_result<installed_skill> read_skill(const std::filesystem::path& folder,
                                        const std::string& architecture) {
  const auto here = read_for(folder, architecture);
  if (auto skills = here.skills(); !skills.empty())
    return std::move(skills.front());
  for (const auto& other : known_architectures())
    if (auto skills = read_for(folder, other).skills(); !skills.empty())
      return std::move(skills.front());
  const auto& problem = here.problems().front();
  return edge_error{error_code::schema_violation,
                    "the build is no skill: " + problem.where
                        + (problem.where.empty() ? "" : ": ") + problem.message,
                    "`roscell check FOLDER` says all that is wrong"};
}

bool is_skill_of(const std::filesystem::path& folder,
                 const std::string& architecture) {
  return !read_for(folder, architecture).skills().empty();
}

} // namespace roscell
