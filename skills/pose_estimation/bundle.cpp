#include "skills/pose_estimation/bundle.hpp"

#include "roscell/skill/errors.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <set>

namespace roscell::pose {

namespace {

using engine::start_error;
using nlohmann::json;

constexpr std::size_t most_bundles = 100;
constexpr std::size_t most_tags = 1000;

[[noreturn]] void refuse_bundle(const std::string& where,
                                const std::string& what) {
  throw start_error("parameter 'bundles' at " + where + " " + what
                    + "; skills/README.md shows a bundle");
}

/// The finite numbers of a list of exactly `count`.
std::vector<double> numbers_at(const json& from, std::size_t count,
                               const std::string& where) {
  std::vector<double> result;
  if (from.is_array() && from.size() == count)
    for (const auto& x : from)
      if (x.is_number() && std::isfinite(x.get<double>()))
        result.push_back(x.get<double>());
  if (result.size() != count)
    refuse_bundle(where, "must be " + std::to_string(count) + " numbers");
  return result;
}

rigid_transform place_at(const json& tag, const std::string& where) {
  rigid_transform result;
  const auto p =
      numbers_at(tag.value("position", json{}), 3, where + "/position");
  result.translation = {p[0], p[1], p[2]};
  if (!tag.contains("orientation"))
    return result;
  const auto q = numbers_at(tag["orientation"], 4, where + "/orientation");
  const Eigen::Quaterniond turn{q[3], q[0], q[1], q[2]};
  constexpr auto typing_error = 0.01;
  if (std::abs(turn.norm() - 1) > typing_error)
    refuse_bundle(where + "/orientation",
                  "must be a quaternion x, y, z, w of length 1");
  result.rotation = turn.normalized().toRotationMatrix();
  return result;
}

bundled_tag tag_at(const json& tag, double usual_size_m,
                   const std::string& where) {
  if (!tag.is_object() || !tag.value("id", json{}).is_number_unsigned()
      || tag["id"].get<std::uint64_t>() > 1'000'000)
    refuse_bundle(where, "must be an object with the 'id' of a tag");
  bundled_tag result;
  result.id = tag["id"].get<int>();
  result.size_m =
      tag.contains("size_m")
          ? numbers_at(json::array({tag["size_m"]}), 1, where + "/size_m")[0]
          : usual_size_m;
  if (!(result.size_m >= 1e-4 && result.size_m <= 100))
    refuse_bundle(where + "/size_m", "must be from 0.0001 to 100 m");
  result.place = place_at(tag, where);
  return result;
}

bundle bundle_at(const json& from, double usual_size_m, std::set<int>& ids,
                 const std::string& where) {
  if (!from.is_object() || !from.value("name", json{}).is_string()
      || from["name"].get<std::string>().empty()
      || !from.value("tags", json{}).is_array() || from["tags"].empty()
      || from["tags"].size() > most_tags)
    refuse_bundle(where, "must be an object with a 'name' and 1 to "
                             + std::to_string(most_tags) + " 'tags'");
  bundle result{from["name"].get<std::string>(), {}};
  for (std::size_t i = 0; i < from["tags"].size(); ++i) {
    const auto place = where + "/tags/" + std::to_string(i);
    result.tags.push_back(tag_at(from["tags"][i], usual_size_m, place));
    if (!ids.insert(result.tags.back().id).second)
      refuse_bundle(place, "has an id that another tag of the bundles has, "
                           "too");
  }
  return result;
}

} // namespace

std::vector<bundle> bundles_of(const engine::parameters& options,
                               double tag_size_m) {
  const auto text = options.json("bundles");
  if (text.empty())
    return {};
  const auto list = json::parse(text, nullptr, false);
  if (!list.is_array() || list.size() > most_bundles)
    refuse_bundle("/", "must be a list of at most "
                           + std::to_string(most_bundles) + " bundles");
  std::vector<bundle> result;
  std::set<int> ids;
  std::set<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto where = "/" + std::to_string(i);
    result.push_back(bundle_at(list[i], tag_size_m, ids, where));
    if (!names.insert(result.back().name).second)
      refuse_bundle(where, "has the name of another bundle");
  }
  return result;
}

} // namespace roscell::pose
