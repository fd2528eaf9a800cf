#include "skills/pose_estimation/bundle_pose.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/pose_estimation/tag_pose.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace roscell::pose {

namespace {

/// A tag of a body that is seen: its corners in the body's frame, and where
/// they are seen, without distortion.
struct seen_tag {
  int id = 0;
  std::array<Eigen::Vector3d, 4> points;
  std::array<Eigen::Vector2d, 4> pixels;
  double side_px = 0;
  std::vector<rigid_transform> guesses; ///< Of the body, by this tag alone.
};

seen_tag look_at_tag(const bundled_tag& tag, const tag_detection& seen,
                     const camera_model& camera) {
  seen_tag result;
  result.id = tag.id;
  const auto corners = seen.camera_corners();
  const auto points = tag_points(tag.size_m);
  for (std::size_t i = 0; i < 4; ++i) {
    result.points[i] = tag.place * points[i];
    result.pixels[i] = camera.undistort(corners[i]);
    result.side_px =
        std::max(result.side_px, (corners[i] - corners[(i + 1) % 4]).norm());
  }
  for (const auto& pose : pose_candidates(corners, tag.size_m, camera))
    result.guesses.push_back(pose * tag.place.inverse());
  return result;
}

/// Root mean square over the corners; without bound behind the camera.
double error_px(const seen_tag& tag, const rigid_transform& body,
                const camera_model& camera) {
  auto sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d point = body * tag.points[i];
    if (!(point.z() > 0))
      return std::numeric_limits<double>::infinity();
    sum += (camera.project(point) - tag.pixels[i]).squaredNorm();
  }
  return std::sqrt(sum / 4);
}

/// A tag that is where it should be is seen so near to its place, once the pose
/// of the body is good: errors of corners grow with what a tag's edges measure.
double most_error_px(const seen_tag& tag) {
  constexpr auto of_corners_px = 2.0;
  constexpr auto of_side = 0.03;
  return std::max(of_corners_px, of_side * tag.side_px);
}

using chosen_tags = std::vector<const seen_tag*>;

rigid_transform fit_all(const chosen_tags& tags, const rigid_transform& start,
                        const camera_model& camera) {
  rigid_fit fit{camera};
  for (const auto* tag : tags)
    for (std::size_t i = 0; i < 4; ++i)
      fit.add(tag->points[i], tag->pixels[i]);
  return fit.minimize(start);
}

/// Those of `tags` that agree with `first`, whose guess is `pose`, and with
/// each other, and the pose of all: the nearest that is left is added as long
/// as all stay where they should be.
std::pair<chosen_tags, rigid_transform>
agreeing_tags(const std::vector<seen_tag>& tags, const seen_tag& first,
              rigid_transform pose, const camera_model& camera) {
  chosen_tags chosen{&first};
  chosen_tags rest;
  for (const auto& tag : tags)
    if (&tag != &first)
      rest.push_back(&tag);
  const auto distance = [&](const seen_tag* tag) {
    return error_px(*tag, pose, camera) / tag->side_px;
  };
  while (!rest.empty()) {
    const auto nearest = std::min_element(rest.begin(), rest.end(),
                                          [&](const auto* a, const auto* b) {
                                            return distance(a) < distance(b);
                                          });
    auto trial = chosen;
    trial.push_back(*nearest);
    rest.erase(nearest);
    const auto fitted = fit_all(trial, pose, camera);
    if (!std::all_of(trial.begin(), trial.end(), [&](const auto* tag) {
          return error_px(*tag, fitted, camera) <= most_error_px(*tag);
        }))
      continue;
    chosen = std::move(trial);
    pose = fitted;
  }
  return {chosen, pose};
}

bundle_pose describe_pose(const std::vector<seen_tag>& tags,
                          const chosen_tags& chosen,
                          const rigid_transform& pose,
                          const camera_model& camera) {
  bundle_pose result;
  result.pose = pose;
  rigid_fit fit{camera};
  for (const auto& tag : tags) {
    const auto agrees =
        std::find(chosen.begin(), chosen.end(), &tag) != chosen.end();
    (agrees ? result.used : result.strayed).push_back(tag.id);
    for (std::size_t i = 0; agrees && i < 4; ++i)
      fit.add(tag.points[i], tag.pixels[i]);
  }
  std::sort(result.used.begin(), result.used.end());
  std::sort(result.strayed.begin(), result.strayed.end());
  const auto at = fit.linearize(pose);
  const auto corners = 4 * chosen.size();
  result.covariance = covariance_of(at, corners);
  result.reprojection_error_px =
      std::sqrt(at.cost / static_cast<double>(corners));
  return result;
}

} // namespace

body_sight locate(const bundle& body, const std::vector<tag_detection>& seen,
                  const camera_model& camera) {
  std::vector<seen_tag> tags;
  for (const auto& tag : body.tags)
    for (const auto& detection : seen)
      if (detection.id == tag.id)
        tags.push_back(look_at_tag(tag, detection, camera));
  // Those that tell most; each of them costs a fit for each of all.
  constexpr std::size_t most_firsts = 8;
  std::sort(tags.begin(), tags.end(),
            [](const auto& a, const auto& b) { return a.side_px > b.side_px; });
  std::optional<bundle_pose> best;
  for (std::size_t i = 0; i < std::min(tags.size(), most_firsts); ++i)
    for (const auto& guess : tags[i].guesses) {
      const auto [chosen, pose] = agreeing_tags(tags, tags[i], guess, camera);
      if (2 * chosen.size() <= tags.size())
        continue;
      const auto found = describe_pose(tags, chosen, pose, camera);
      if (!best || found.used.size() > best->used.size()
          || (found.used.size() == best->used.size()
              && found.reprojection_error_px < best->reprojection_error_px))
        best = found;
    }
  return {best, !best && tags.size() > 1};
}

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
