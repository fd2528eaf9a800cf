#include "tools/render_scenes/scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

namespace roscell::scenes {

camera::camera(const scene_options& options)
    : focal_px_(options.focal_px),
      centre_((options.width - 1) / 2.0, (options.height - 1) / 2.0),
      distortion_(options.distortion),
      distorted_(std::any_of(distortion_.begin(), distortion_.end(),
                             [](double k) { return k != 0; })) {
  // nop
}

/// Brown and Conrady's model as ROS and OpenCV write it.
Eigen::Vector2d camera::bent(const Eigen::Vector2d& straight) const {
  const auto [k1, k2, p1, p2, k3] = distortion_;
  const auto x = straight.x();
  const auto y = straight.y();
  const auto r2 = x * x + y * y;
  const auto radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Eigen::Vector2d camera::pixel_of(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d straight = point.head<2>() / point.z();
  return focal_px_ * (distorted_ ? bent(straight) : straight) + centre_;
}

/// Inverts the distortion by correcting a guess by what it misses, which
/// converges as long as the distortion is mild.
Eigen::Vector3d camera::ray_of(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d seen = (pixel - centre_) / focal_px_;
  auto straight = seen;
  for (auto i = 0; distorted_ && i < 20; ++i)
    straight += seen - bent(straight);
  return straight.homogeneous();
}

namespace {

using quad = std::array<Eigen::Vector2d, 4>;

constexpr double degree = 3.14159265358979323846 / 180;

/// Pixels that stay free around each tag, and at the border of the image.
constexpr double gap_px = 6;

/// Whether a line along one of the edges of `a` has all of `b` on its other
/// side. Corners go round anticlockwise as one sees them.
bool has_separating_edge(const quad& a, const quad& b) {
  for (std::size_t i = 0; i < 4; ++i) {
    Eigen::Vector2d edge = a[(i + 1) % 4] - a[i];
    Eigen::Vector2d outward{-edge.y(), edge.x()};
    outward.normalize();
    auto is_beyond = [&](const Eigen::Vector2d& corner) {
      return (corner - a[i]).dot(outward) > gap_px;
    };
    if (std::all_of(b.begin(), b.end(), is_beyond))
      return true;
  }
  return false;
}

bool is_in_view(const quad& q, const scene_options& options) {
  return std::all_of(q.begin(), q.end(), [&](const Eigen::Vector2d& corner) {
    return corner.x() > gap_px && corner.x() < options.width - 1 - gap_px
           && corner.y() > gap_px && corner.y() < options.height - 1 - gap_px;
  });
}

/// Draws poses and keeps those that do not get into each other's way.
class placement {
public:
  placement(const scene_options& options, double margin, std::uint64_t seed)
      : options_(options), eye_(options),
        sheet_m_(options.tag_size_m * (1 + 2 * margin)), random_(seed) {
    // nop
  }

  /// Nothing if the tags do not fit.
  std::optional<std::vector<placed_tag>> place(double nearest_m) {
    std::vector<double> distances(options_.tags);
    for (auto& distance_m : distances)
      distance_m = between(nearest_m, options_.farthest_m);
    // The large ones first, as long as there is room.
    std::sort(distances.begin(), distances.end());
    for (auto distance_m : distances)
      if (!place_one(distance_m))
        return std::nullopt;
    // Ids should not tell the distance.
    std::shuffle(tags_.begin(), tags_.end(), random_);
    for (std::size_t i = 0; i < tags_.size(); ++i)
      tags_[i].id = static_cast<int>(i);
    return tags_;
  }

private:
  double between(double least, double most) {
    return std::uniform_real_distribution{least, most}(random_);
  }

  bool place_one(double distance_m) {
    constexpr auto most_tries = 3000;
    for (auto i = 0; i < most_tries; ++i) {
      auto tag = draw(distance_m);
      auto outline = corners_of(tag, sheet_m_, eye_);
      auto is_free = [&](const quad& other) {
        return has_separating_edge(outline, other)
               || has_separating_edge(other, outline);
      };
      if (!is_in_view(outline, options_)
          || !std::all_of(outlines_.begin(), outlines_.end(), is_free))
        continue;
      tags_.push_back(tag);
      outlines_.push_back(outline);
      return true;
    }
    return false;
  }

  /// A tag somewhere in view, tilted away from the line of sight in a random
  /// direction, and turned about its own axis.
  placed_tag draw(double distance_m) {
    Eigen::Vector2d pixel{between(0, options_.width),
                          between(0, options_.height)};
    Eigen::Vector3d sight = eye_.ray_of(pixel).normalized();
    auto facing =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -sight);
    auto tilt = between(0, options_.most_tilt_deg) * degree;
    auto towards = between(0, 360) * degree;
    Eigen::AngleAxisd tilted{
        tilt, Eigen::Vector3d{std::cos(towards), std::sin(towards), 0}};
    Eigen::AngleAxisd turned{between(0, 360) * degree,
                             Eigen::Vector3d::UnitZ()};
    return {0, sight * distance_m, facing * tilted * turned};
  }

  const scene_options& options_;
  const camera eye_;
  const double sheet_m_;
  std::mt19937_64 random_;
  std::vector<placed_tag> tags_;
  std::vector<quad> outlines_;
};

} // namespace

std::array<Eigen::Vector2d, 4> corners_of(const placed_tag& tag, double size_m,
                                          const camera& eye) {
  auto h = size_m / 2;
  auto corner = [&](double x, double y) {
    return eye.pixel_of(tag.orientation * Eigen::Vector3d{x, y, 0}
                        + tag.position);
  };
  return {corner(-h, -h), corner(h, -h), corner(h, h), corner(-h, h)};
}

std::vector<placed_tag> place_tags(const scene_options& options,
                                   double margin) {
  constexpr auto closer_by = 1.1;
  for (auto nearest_m = options.nearest_m; nearest_m <= options.farthest_m;
       nearest_m *= closer_by) {
    placement attempt{options, margin, options.seed};
    if (auto tags = attempt.place(nearest_m))
      return *tags;
  }
  throw std::runtime_error(
      std::to_string(options.tags)
      + " tags do not fit into the picture; make them smaller, or the picture "
        "larger");
}

} // namespace roscell::scenes
