#include "actors/instances/skills/skill_places.hpp"

#include "actors/edge/host/own_process.hpp"
#include "actors/instances/skills/skill_descriptor_file.hpp"

#include <set>
#include <system_error>

namespace roscell {

namespace fs = std::filesystem;

std::vector<fs::path> skill_places::present() const {
  auto result = named;
  std::error_code ignored;
  for (const auto& x : usual)
    if (fs::is_directory(x, ignored) && !names_folder(result, x))
      result.push_back(x);
  return result;
}

std::vector<watched_folder> skill_places::to_watch() const {
  std::vector<watched_folder> result;
  for (const auto* list : {&named, &usual})
    for (const auto& x : *list)
      result.push_back({x});
  std::set<fs::path> skills;
  std::set<fs::path> others;
  for (const auto& directory : present()) {
    std::error_code error;
    for (fs::directory_iterator i{directory, error}, end; !error && i != end;
         i.increment(error)) {
      std::error_code gone;
      if (i->is_directory(gone))
        (descriptor_files(i->path()).empty() ? others : skills)
            .insert(i->path());
    }
  }
  for (const auto& x : skills)
    result.push_back({x, true});
  for (const auto& x : others)
    result.push_back({x});
  return result;
}

} // namespace roscell
