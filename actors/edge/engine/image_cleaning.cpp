#include "actors/edge/engine/image_cleaning.hpp"

#include "actors/edge/engine/engine_json.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using document = nlohmann::json;

constexpr std::string_view built_prefix = "roscell/";

/// Podman leaves out what comes before the digits.
std::string bare_id(const std::string& id) {
  return id.substr(id.find(':') == std::string::npos ? 0 : id.find(':') + 1);
}

/// As we call it: Podman adds where it would be pulled from.
std::string own_name(const std::string& name) {
  for (const std::string_view before : {"docker.io/", "localhost/"})
    if (name.compare(0, before.size(), before) == 0)
      return name.substr(before.size());
  return name;
}

} // namespace

std::vector<built_image> built_images_in(const document& images) {
  std::vector<built_image> result;
  if (!images.is_array())
    return result;
  for (const auto& x : images) {
    const auto names = x.is_object() ? x.find("RepoTags") : x.end();
    if (!x.is_object() || names == x.end() || !names->is_array())
      continue;
    const auto created = x.find("Created");
    for (const auto& name : *names)
      if (name.is_string()
          && own_name(name.get<std::string>())
                     .compare(0, built_prefix.size(), built_prefix)
                 == 0)
        result.push_back({own_name(name.get<std::string>()),
                          bare_id(text_at(x, "Id")),
                          created != x.end() && created->is_number_integer()
                              ? created->get<int64_t>()
                              : 0});
  }
  return result;
}

std::set<std::string> used_images_in(const document& containers) {
  std::set<std::string> result;
  if (containers.is_array())
    for (const auto& x : containers)
      if (x.is_object())
        result.insert(bare_id(text_at(x, "ImageID")));
  return result;
}

std::vector<std::string> images_to_remove(std::vector<built_image> images,
                                          const std::set<std::string>& used,
                                          const std::set<std::string>& named,
                                          size_t kept) {
  images.erase(std::remove_if(images.begin(), images.end(),
                              [&](const auto& x) {
                                return used.count(x.id) != 0
                                       || named.count(x.name) != 0;
                              }),
               images.end());
  std::sort(images.begin(), images.end(), [](const auto& a, const auto& b) {
    return std::pair{a.created_unix_s, a.name}
           < std::pair{b.created_unix_s, b.name};
  });
  std::vector<std::string> result;
  for (size_t i = 0; i + kept < images.size(); ++i)
    result.push_back(images[i].name);
  return result;
}

} // namespace roscell
