#include "actors/cell/tables/image_sources.hpp"

#include "actors/builds/limits.hpp"

#include <algorithm>

namespace roscell {

image_choice choose_image(const image_holders& holders,
                          const std::set<std::string>& gave_before) {
  std::map<std::string, std::vector<std::string>> nodes;
  for (const auto& [node, id] : holders)
    if (!id.empty())
      nodes[id].push_back(node);
  image_choice result;
  for (auto& [id, having] : nodes)
    if (having.size() > result.nodes.size())
      result = {id, std::move(having)};
  std::stable_partition(
      result.nodes.begin(), result.nodes.end(),
      [&](const auto& node) { return gave_before.count(node) != 0; });
  return result;
}

image_readers::entry* image_readers::find(const std::string& build) {
  const auto found =
      std::find_if(builds_.begin(), builds_.end(),
                   [&](const auto& x) { return x.build == build; });
  return found == builds_.end() ? nullptr : &*found;
}

void image_readers::add_source(const std::string& image_id,
                               const std::string& build,
                               const std::string& node) {
  auto* known = find(build);
  if (known == nullptr) {
    if (builds_.size() == limits::image::remembered)
      builds_.pop_front();
    known = &builds_.emplace_back();
    known->build = build;
    known->image_id = image_id;
  }
  known->givers.insert(node);
  known->nodes.insert(node);
}

void image_readers::add_reader(const std::string& build,
                               const std::string& node) {
  if (auto* known = find(build))
    known->nodes.insert(node);
}

std::vector<std::string>
image_readers::of_build(const std::string& build) const {
  for (const auto& x : builds_)
    if (x.build == build)
      return {x.nodes.begin(), x.nodes.end()};
  return {};
}

std::set<std::string>
image_readers::givers_of(const std::string& image_id) const {
  std::set<std::string> result;
  for (const auto& x : builds_)
    if (x.image_id == image_id)
      result.insert(x.givers.begin(), x.givers.end());
  return result;
}

} // namespace roscell
