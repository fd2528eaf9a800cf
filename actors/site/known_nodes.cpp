#include "actors/site/known_nodes.hpp"

namespace roscell {

void known_nodes::add(const std::string& name, const std::string& uuid) {
  const std::lock_guard guard{mutex_};
  if (names_.size() < most && names_.emplace(uuid, name).second)
    ++uuids_by_name_[name];
}

known_nodes::claim known_nodes::judge(const std::string& name,
                                      const std::string& uuid) const {
  const std::lock_guard guard{mutex_};
  const auto found = names_.find(uuid);
  if (found != names_.end())
    return found->second == name ? claim::by_name : claim::taken;
  return uuids_by_name_.count(name) > 0 ? claim::by_name : claim::free;
}

} // namespace roscell
