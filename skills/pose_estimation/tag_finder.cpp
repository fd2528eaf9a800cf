#include "skills/pose_estimation/tag_finder.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace roscell::pose {

tag_finder::tag_finder(const engine::parameters& options,
                       engine::say_function say)
    : say_(std::move(say)),
      tag_size_m_(options.number("tag_size_m", 0.08, 1e-4, 100)),
      detector_(detector_options::of(options)),
      bundles_(bundles_of(options, tag_size_m_)), frames_(say_) {
  for (const auto& body : bundles_)
    for (const auto& tag : body.tags)
      sizes_m_.emplace(tag.id, tag.size_m);
}

void tag_finder::find(const vision::gray_view& image,
                      const std::optional<camera_model>& camera,
                      const image_origin& origin, frame_result& result) {
  result.family = detector_.family();
  for (auto& detection : detector_.detect(image)) {
    found_tag tag;
    tag.size_m = size_of(detection.id);
    tag.frame =
        origin.prefix + result.family + ":" + std::to_string(detection.id);
    if (camera)
      tag.pose = estimate_pose(detection.camera_corners(), tag.size_m, *camera);
    tag.detection = std::move(detection);
    result.tags.push_back(std::move(tag));
  }
  keep_frames(origin, result);
  if (camera)
    find_bundles(*camera, origin, result);
}

double tag_finder::size_of(int id) const {
  const auto bundled = sizes_m_.find(id);
  return bundled != sizes_m_.end() ? bundled->second : tag_size_m_;
}

/// Tags are in the order of ids.
void tag_finder::keep_frames(const image_origin& origin, frame_result& result) {
  const auto now = frame_keeper::clock::now();
  auto& tags = result.tags;
  const auto has_id_of = [&](std::size_t i, std::size_t other) {
    return other < tags.size()
           && tags[i].detection.id == tags[other].detection.id;
  };
  for (std::size_t i = 0; i < tags.size(); ++i) {
    auto& tag = tags[i];
    tag.is_twin = has_id_of(i, i + 1) || (i > 0 && has_id_of(i, i - 1));
    if (tag.is_twin)
      frames_.refuse_twins(tag.frame, origin.camera);
    tag.in_tf = tag.pose && !tag.is_twin
                && frames_.may_send(origin.tree, tag.frame, origin.source,
                                    origin.camera, now);
  }
}

void tag_finder::find_bundles(const camera_model& camera,
                              const image_origin& origin,
                              frame_result& result) {
  if (bundles_.empty())
    return;
  std::vector<tag_detection> seen;
  for (const auto& tag : result.tags)
    if (!tag.is_twin)
      seen.push_back(tag.detection);
  for (const auto& body : bundles_) {
    const auto sight = locate(body, seen, camera);
    if (sight.ambiguous)
      say_once(origin, "the tags of bundle '" + body.name
                           + "' do not agree on where it is; measure their "
                             "places again");
    if (!sight.where)
      continue;
    for (auto id : sight.where->strayed)
      say_once(origin, "tag " + std::to_string(id) + " of bundle '" + body.name
                           + "' is not where the bundle says; measure its "
                             "place again");
    const auto frame = origin.prefix + body.name;
    result.bundles.push_back(
        {frame, *sight.where,
         frames_.may_send(origin.tree, frame, origin.source, origin.camera,
                          frame_keeper::clock::now())});
  }
}

void tag_finder::say_once(const image_origin& origin, const std::string& line) {
  const auto said = "'" + origin.camera + "': " + line;
  if (said_.insert(said).second)
    say_(said);
}

namespace {

constexpr std::chrono::seconds out_of_view{1};

} // namespace

bool frame_keeper::may_send(std::size_t tree, const std::string& frame,
                            std::size_t source, const std::string& camera,
                            clock::time_point now) {
  if (owners_.size() >= forget_at_)
    forget_out_of_view(now);
  auto& last = owners_[{tree, frame}];
  if (last.camera.empty() || last.source == source
      || now - last.seen > out_of_view) {
    last = {source, camera, now};
    return true;
  }
  say_once("'" + camera + "' and '" + last.camera + "' both see '" + frame
           + "'; TF gets it of the one that saw it first: give each camera a "
             "prefix of its own by the parameter 'tag_prefixes'");
  return false;
}

void frame_keeper::forget_out_of_view(clock::time_point now) {
  for (auto i = owners_.begin(); i != owners_.end();)
    i = now - i->second.seen > out_of_view ? owners_.erase(i) : std::next(i);
  // With so many in view it need not be looked at again soon.
  forget_at_ = std::max(most_frames, 2 * owners_.size());
}

void frame_keeper::refuse_twins(const std::string& frame,
                                const std::string& camera) {
  say_once("'" + camera + "' sees '" + frame
           + "' more than once, so that TF gets it not at all; use each tag "
             "once");
}

void frame_keeper::say_once(const std::string& line) {
  // Bounds the memory; after that many lines one more does not matter.
  constexpr std::size_t most_lines = 1000;
  if (said_.size() >= most_lines)
    said_.clear();
  if (said_.insert(line).second)
    say_(line);
}

} // namespace roscell::pose
