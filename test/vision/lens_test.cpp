#include "skills/vision/lens.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace roscell;
using namespace roscell::vision;
using Catch::Matchers::Contains;

namespace {

using numbers = std::vector<double>;

ros2::sensor_msgs::camera_info info_of(const std::string& model, numbers d) {
  ros2::sensor_msgs::camera_info result;
  result.distortion_model = model;
  result.d = std::move(d);
  return result;
}

lens lens_of(const std::string& model, const numbers& d) {
  return std::get<lens>(lens::of(info_of(model, d)));
}

std::string problem_of(const std::string& model, const numbers& d) {
  const auto result = lens::of(info_of(model, d));
  const auto* problem = std::get_if<std::string>(&result);
  return problem != nullptr ? *problem : "none";
}

/// A lens, and where cv2.projectPoints and cv2.fisheye.projectPoints of OpenCV
/// put the directions (0.6, -0.3) and (-0.2, 0.5).
struct known_lens {
  const char* model;
  numbers d;
  lens::point first;
  lens::point second;
};

const std::vector<known_lens>& known_lenses() {
  static const std::vector<known_lens> result{
      {"plumb_bob",
       {-0.2, 0.05, 0.001, -0.002},
       {0.549375, -0.2746875},
       {-0.190181, 0.4742925}},
      {"plumb_bob",
       {-0.2, 0.05, 0.001, -0.002, 0.01},
       {0.54992175, -0.274960875},
       {-0.190229778, 0.474414445}},
      {"rational_polynomial",
       {0.5, 0.1, 1e-3, 2e-3, 0.01, 0.8, 0.2, 0.03},
       {0.534818345714, -0.266509172857},
       {-0.184110850012, 0.462017125031}},
      {"rational_polynomial",
       {0.5, 0.1, 1e-3, 2e-3, 0.01, 0.8, 0.2, 0.03, 0.01, -0.004, 0.006, 0.002},
       {0.538508345714, -0.263404172857},
       {-0.181547250012, 0.463925325031}},
      {"rational_polynomial",
       {0.5, 0.1, 1e-3, 2e-3, 0.01, 0.8, 0.2, 0.03, 0.01, -0.004, 0.006, 0.002,
        0.03, -0.05},
       {0.549656162652, -0.267817469257},
       {-0.182657186868, 0.466114229098}},
      {"equidistant",
       {0.05, -0.01, 0.004, -0.001},
       {0.537156221545, -0.268578110773},
       {-0.185600215961, 0.464000539903}},
      {"equidistant",
       {0, 0, 0, 0},
       {0.528492654151, -0.264246327075},
       {-0.183461037306, 0.458652593264}}};
  return result;
}

void check_point(const lens::point& found, const lens::point& expected) {
  CHECK(found.x == Approx(expected.x).margin(1e-9));
  CHECK(found.y == Approx(expected.y).margin(1e-9));
}

} // namespace

TEST_CASE("lenses of every number of coefficients bend as OpenCV does, and "
          "back",
          "[lens]") {
  for (const auto& [model, d, first, second] : known_lenses()) {
    CAPTURE(model, d.size());
    const auto bending = lens_of(model, d);
    CHECK(bending.distorts());
    check_point(bending.bend({0.6, -0.3}), first);
    check_point(bending.bend({-0.2, 0.5}), second);
    for (auto x = -0.7; x <= 0.7; x += 0.2)
      for (auto y = -0.5; y <= 0.5; y += 0.2)
        check_point(bending.straighten(bending.bend({x, y})), {x, y});
  }
}

TEST_CASE("coefficients that are zero at the end do not count", "[lens]") {
  auto long_list = numbers{-0.2, 0.05, 0.001, -0.002, 0.01};
  const auto before = lens_of("plumb_bob", long_list).bend({0.3, 0.2});
  for (auto count : {8, 12, 14}) {
    long_list.resize(static_cast<std::size_t>(count));
    for (const auto* model : {"plumb_bob", "rational_polynomial"}) {
      const auto after = lens_of(model, long_list).bend({0.3, 0.2});
      CHECK(after.x == before.x);
      CHECK(after.y == before.y);
    }
  }
  CHECK_FALSE(lens_of("plumb_bob", numbers(14)).distorts());
  CHECK_FALSE(lens_of("", numbers(5)).distorts());
}

TEST_CASE("other numbers of coefficients are refused", "[lens]") {
  CHECK_THAT(problem_of("plumb_bob", {1, 2, 3, 4, 5, 6}),
             Contains("6 distortion coefficients")
                 && Contains("4, 5, 8, 12 or 14"));
  CHECK_THAT(problem_of("rational_polynomial", numbers(15, 0.1)),
             Contains("15 distortion coefficients"));
  CHECK_THAT(problem_of("equidistant", numbers(5, 0.1)), Contains("has 4"));
  CHECK_THAT(problem_of("ftheta", {0.1}), Contains("'ftheta'"));
}

TEST_CASE("what lies beside an equidistant lens has no direction", "[lens]") {
  const auto wide = lens_of("equidistant", {0, 0, 0, 0});
  CHECK(std::isfinite(wide.straighten({1.5, 0}).x));
  CHECK(std::isnan(wide.straighten({1.6, 0}).x));
  CHECK(std::isnan(wide.straighten({40, 40}).x));
}
