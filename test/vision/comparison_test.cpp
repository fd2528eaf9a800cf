#include "tools/compare_poses/reading.hpp"
#include "tools/compare_poses/table.hpp"

#include "test/skills/temp_folder.hpp"

#include <catch2/catch.hpp>

using namespace roscell::comparison;
using Catch::Matchers::Contains;
using roscell::test::temp_folder;

namespace {

pose at(double z) {
  return {{0, 0, z}, Eigen::Quaterniond::Identity()};
}

pose turned(double degrees) {
  return {{0, 0, 1},
          Eigen::Quaterniond{Eigen::AngleAxisd{degrees * M_PI / 180,
                                               Eigen::Vector3d::UnitY()}}};
}

constexpr pose_error limit{1, 2};

} // namespace

TEST_CASE("errors are percent of the distance and degrees") {
  auto off = error_of(at(2.02), at(2));
  CHECK(off.distance_percent == Approx(1));
  CHECK(off.rotation_deg == Approx(0).margin(1e-6));
  CHECK(error_of(turned(30), at(1)).rotation_deg == Approx(30));
  auto negated = turned(30);
  negated.orientation.coeffs() *= -1;
  CHECK(error_of(negated, turned(30)).rotation_deg == Approx(0).margin(1e-5));
}

TEST_CASE("a comparison needs every tag, and takes medians over frames") {
  true_poses truth{{1, at(1)}, {2, at(2)}};
  estimated_poses estimates{{1, {at(1), at(1.009), at(5)}}, {2, {at(2)}}};
  auto scene = compare("scene", truth, estimates);
  CHECK(scene.tags[0].frames == 3);
  CHECK(scene.tags[0].error.distance_percent == Approx(0.9));
  auto good = summarize({scene});
  CHECK(good.found == 2);
  CHECK(good.is_within(limit));
  estimates.erase(2);
  CHECK_FALSE(summarize({compare("scene", truth, estimates)}).is_within(limit));
  CHECK_FALSE(summarize({}).is_within(limit));
}

TEST_CASE("a median above its limit is not within it") {
  true_poses truth{{1, at(1)}};
  CHECK_FALSE(
      summarize({compare("", truth, {{1, {at(1.02)}}})}).is_within(limit));
  CHECK_FALSE(
      summarize({compare("", truth, {{1, {turned(3)}}})}).is_within(limit));
  CHECK(summarize({compare("", truth, {{1, {turned(1)}}})}).is_within(limit));
}

TEST_CASE("truth and estimates are read from their files") {
  temp_folder folder;
  folder.write("truth.json", R"({"tags": [{"id": 3, "pose":
    {"position": [1, 2, 3], "orientation": [1, 0, 0, 0]}}]})");
  folder.write("poses", R"({"tags": [{"id": 3, "pose": null}]}
{"tags": [{"id": 3, "pose": {"position": [1, 2, 3], "orientation": [1,0,0,0]}}]}
{"tags": [{"id": 4, "pose": {"position": [4, 2, 3], "orientation": [1,0,0,0]}}]}
{"tags": [{"id": 5, "po)");
  auto truth = read_truth(folder / "truth.json");
  REQUIRE(truth.size() == 1);
  CHECK(truth[3].position.isApprox(Eigen::Vector3d{1, 2, 3}));
  CHECK(truth[3].orientation.x() == 1);
  // A line without its newline is still being written.
  auto estimates = read_estimates(folder / "poses", 0);
  CHECK(estimates.size() == 2);
  CHECK(estimates[3].size() == 1);
  CHECK(read_estimates(folder / "poses", 1).count(3) == 0);
}

TEST_CASE("a file that is something else is an error that names it") {
  temp_folder folder;
  folder.write("truth.json", "{}");
  folder.write("poses", "{\"tags\": []}\nhello\n");
  CHECK_THROWS_WITH(read_truth(folder / "truth.json"),
                    Contains("truth.json' is no truth.json"));
  CHECK_THROWS_WITH(read_truth(folder / "none"), Contains("cannot read"));
  CHECK_THROWS_WITH(read_estimates(folder / "poses", 0), Contains("line 2"));
}

TEST_CASE("the tables show what was found, missed and not expected") {
  true_poses truth{{1, at(1)}, {2, at(2)}};
  auto scene = compare("scene_1", truth, {{1, {at(1.01)}}, {9, {at(1)}}});
  CHECK_THAT(tag_table(scene), Contains("not found") && Contains("1.000")
                                   && Contains("9  is not in the scene"));
  CHECK_THAT(scene_table({scene}), Contains("all"));
}
