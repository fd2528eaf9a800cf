#include "skills/vision/lens.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace roscell::vision {

namespace {

struct known_model {
  std::string_view name;
  std::size_t coefficients;
};

constexpr std::array<known_model, 3> models{
    {{"plumb_bob", 5}, {"rational_polynomial", 8}, {"equidistant", 4}}};

} // namespace

std::variant<lens, std::string>
lens::of(const ros2::sensor_msgs::camera_info& info) {
  const auto& d = info.d;
  if (!std::all_of(d.begin(), d.end(),
                   [](double x) { return std::isfinite(x); }))
    return "holds a distortion that is no number; calibrate the camera";
  if (std::all_of(d.begin(), d.end(), [](double x) { return x == 0; }))
    return lens{};
  const auto* model =
      std::find_if(models.begin(), models.end(), [&](const auto& x) {
        return x.name == info.distortion_model;
      });
  if (model == models.end())
    return "has the distortion model '" + info.distortion_model
           + "', which is none of plumb_bob, rational_polynomial and "
             "equidistant; calibrate the camera with one of these";
  if (d.size() > model->coefficients)
    return "has " + std::to_string(d.size()) + " distortion coefficients, but "
           + info.distortion_model + " has "
           + std::to_string(model->coefficients) + "; calibrate the camera";
  lens result;
  std::copy(d.begin(), d.end(), result.coefficients_.begin());
  result.kind_ =
      model->name == "equidistant" ? kind::equidistant : kind::polynomial;
  return result;
}

lens::bend lens::bend_at(double x, double y) const {
  switch (kind_) {
  case kind::polynomial:
    return bend_polynomial(x, y);
  case kind::equidistant:
    return bend_equidistant(x, y);
  default:
    return {};
  }
}

lens::bend lens::bend_polynomial(double x, double y) const {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = coefficients_;
  auto r2 = x * x + y * y;
  auto radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3)))
                / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
  return {radial, 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

lens::bend lens::bend_equidistant(double x, double y) const {
  auto r = std::hypot(x, y);
  if (r == 0)
    return {};
  const auto& k = coefficients_;
  auto angle = std::atan(r);
  auto a2 = angle * angle;
  auto seen = angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
  return {seen / r, 0, 0};
}

ros2::sensor_msgs::camera_info
describe_sent_images(ros2::sensor_msgs::camera_info info) {
  // Zero means the whole image, and zero binning none.
  const auto& part = info.roi;
  if (part.width != 0 && part.height != 0) {
    info.width = part.width;
    info.height = part.height;
    info.k[2] -= part.x_offset;
    info.k[5] -= part.y_offset;
    info.p[2] -= part.x_offset;
    info.p[6] -= part.y_offset;
  }
  auto across = std::max(info.binning_x, 1U);
  auto down = std::max(info.binning_y, 1U);
  info.width /= across;
  info.height /= down;
  for (auto i : {0, 2}) {
    info.k[i] /= across;
    info.p[i] /= across;
  }
  for (auto i : {4, 5})
    info.k[i] /= down;
  for (auto i : {5, 6})
    info.p[i] /= down;
  info.roi = {};
  info.binning_x = 0;
  info.binning_y = 0;
  return info;
}

} // namespace roscell::vision
