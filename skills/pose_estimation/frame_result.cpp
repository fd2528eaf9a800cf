#include "skills/pose_estimation/frame_result.hpp"

#include <algorithm>

namespace roscell::pose {

namespace {

using nlohmann::json;

ros2::apriltag_msgs::point to_point(const Eigen::Vector2d& pixel) {
  return {pixel.x(), pixel.y()};
}

json to_json(const Eigen::Vector2d& pixel) {
  return {pixel.x(), pixel.y()};
}

json to_json(const tag_pose& pose) {
  const auto& p = pose.position;
  const auto& q = pose.orientation;
  return {{"position", {p.x(), p.y(), p.z()}},
          {"orientation", {q.x(), q.y(), q.z(), q.w()}},
          {"reprojection_error_px", pose.reprojection_error_px}};
}

json to_json(const found_tag& tag, const std::string& family) {
  auto corners = json::array();
  for (const auto& corner : tag.detection.corners)
    corners.push_back(to_json(corner));
  return {{"family", family},
          {"id", tag.detection.id},
          {"hamming", tag.detection.hamming},
          {"decision_margin", tag.detection.decision_margin},
          {"centre_px", to_json(tag.detection.centre)},
          {"corners_px", corners},
          {"pose", tag.pose ? to_json(*tag.pose) : json{}},
          {"frame", tag.frame},
          {"in_tf", tag.in_tf && tag.pose.has_value()}};
}

/// Of a body.
json to_json(const found_bundle& body) {
  const auto& pose = body.where.pose;
  const auto& p = pose.translation;
  const Eigen::Quaterniond q{pose.rotation};
  return {{"frame", body.frame},
          {"in_tf", body.in_tf},
          {"tags", body.where.used},
          {"strayed", body.where.strayed},
          {"pose",
           {{"position", {p.x(), p.y(), p.z()}},
            {"orientation", {q.x(), q.y(), q.z(), q.w()}},
            {"reprojection_error_px", body.where.reprojection_error_px},
            {"covariance", body.where.covariance}}}};
}

ros2::geometry_msgs::transform to_transform(const Eigen::Vector3d& p,
                                            const Eigen::Quaterniond& q) {
  return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

ros2::vision_msgs::detection3_d
to_detection3d(const frame_result& result, const std::string& frame,
               const Eigen::Vector3d& p, const Eigen::Quaterniond& q,
               const pose_covariance& covariance) {
  ros2::vision_msgs::detection3_d one;
  one.header = result.header;
  one.id = frame;
  one.bbox.center = {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
  ros2::vision_msgs::object_hypothesis_with_pose guess;
  guess.hypothesis = {frame, 1};
  guess.pose = {one.bbox.center, covariance};
  one.results.push_back(std::move(guess));
  return one;
}

} // namespace

ros2::tf2_msgs::tf_message to_tf_message(const frame_result& result) {
  ros2::tf2_msgs::tf_message message;
  const auto add = [&](const std::string& frame, const Eigen::Vector3d& p,
                       const Eigen::Quaterniond& q) {
    message.transforms.push_back({result.header, frame, to_transform(p, q)});
  };
  for (const auto& tag : result.tags)
    if (tag.pose && tag.in_tf)
      add(tag.frame, tag.pose->position, tag.pose->orientation);
  for (const auto& body : result.bundles)
    if (body.in_tf)
      add(body.frame, body.where.pose.translation,
          Eigen::Quaterniond{body.where.pose.rotation});
  return message;
}

ros2::vision_msgs::detection3_d_array
to_detection3d_array(const frame_result& result) {
  ros2::vision_msgs::detection3_d_array message;
  message.header = result.header;
  for (const auto& tag : result.tags)
    if (tag.pose)
      message.detections.push_back(
          to_detection3d(result, tag.frame, tag.pose->position,
                         tag.pose->orientation, tag.pose->covariance));
  for (const auto& body : result.bundles)
    message.detections.push_back(to_detection3d(
        result, body.frame, body.where.pose.translation,
        Eigen::Quaterniond{body.where.pose.rotation}, body.where.covariance));
  return message;
}

ros2::apriltag_msgs::april_tag_detection_array
to_detection_array(const frame_result& result) {
  ros2::apriltag_msgs::april_tag_detection_array message;
  message.header = result.header;
  for (const auto& tag : result.tags) {
    ros2::apriltag_msgs::april_tag_detection one;
    one.family = result.family;
    one.id = tag.detection.id;
    one.hamming = tag.detection.hamming;
    one.decision_margin = tag.detection.decision_margin;
    one.centre = to_point(tag.detection.centre);
    std::transform(tag.detection.corners.begin(), tag.detection.corners.end(),
                   one.corners.begin(), to_point);
    one.homography = tag.detection.homography;
    message.detections.push_back(std::move(one));
  }
  return message;
}

json to_json(const frame_result& result) {
  auto tags = json::array();
  for (const auto& tag : result.tags)
    tags.push_back(to_json(tag, result.family));
  auto bundles = json::array();
  for (const auto& body : result.bundles)
    bundles.push_back(to_json(body));
  using milliseconds = std::chrono::duration<double, std::milli>;
  const auto& stamp = result.header.stamp;
  return {{"frame", result.frame_name},
          {"source", result.source},
          {"frame_id", result.header.frame_id},
          {"stamp", stamp.sec + stamp.nanosec * 1e-9},
          {"width", result.width},
          {"height", result.height},
          {"processing_ms", milliseconds{result.processing_time}.count()},
          {"age_ms", milliseconds{result.age}.count()},
          {"tags", tags},
          {"bundles", bundles}};
}

} // namespace roscell::pose
