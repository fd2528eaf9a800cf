#include "actors/instances/skill_folder.hpp"

#include "actors/edge/disk/folder_hash.hpp"

#include <string>
#include <utility>

namespace roscell {

edge_result<bool> check_build(const prepare_image& request) {
  const auto look = read_folder(request.skill_dir);
  if (const auto* now = std::get_if<folder_fingerprint>(&look);
      now != nullptr && now->state == request.look)
    return true;
  auto hash = hash_folder(request.skill_dir);
  if (auto* why = std::get_if<edge_error>(&hash))
    return std::move(*why);
  if (std::get<std::string>(hash) == request.skill)
    return true;
  return edge_error{error_code::engine_failed,
                    "the skill folder '" + request.skill_dir
                        + "' was edited after this node had read it: it is not "
                          "build "
                        + request.skill.substr(0, 12) + " any more",
                    "restart the node, so that it offers what is there now"};
}

} // namespace roscell
