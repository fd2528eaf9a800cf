#include "tools/compare_poses/comparison.hpp"

#include "test/skills/files.hpp"

#include <catch2/catch.hpp>

#include <sstream>

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

estimates only(int tag, const pose& estimate) {
  return {{{tag, {estimate}}}, {}};
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
  estimates estimated{{{1, {at(1), at(1.009), at(5)}}, {2, {at(2)}}}, {}};
  auto scene = compare("scene", truth, estimated);
  CHECK(scene.tags[0].frames == 3);
  CHECK(scene.tags[0].error.distance_percent == Approx(0.9));
  auto good = summarize({scene});
  CHECK(good.found == 2);
  CHECK(good.is_within(limit));
  estimated.poses.erase(2);
  CHECK_FALSE(summarize({compare("scene", truth, estimated)}).is_within(limit));
  CHECK_FALSE(summarize({}).is_within(limit));
}

TEST_CASE("a median above its limit is not within it") {
  true_poses truth{{1, at(1)}};
  auto is_within_limit = [&](const pose& estimate) {
    return summarize({compare("", truth, only(1, estimate))}).is_within(limit);
  };
  CHECK_FALSE(is_within_limit(at(1.02)));
  CHECK_FALSE(is_within_limit(turned(3)));
  CHECK(is_within_limit(turned(1)));
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
  auto found = read_estimates(folder / "poses", 0);
  CHECK(found.poses.size() == 2);
  CHECK(found.poses[3].size() == 1);
  CHECK_FALSE(found.timing.rate_hz);
  CHECK_FALSE(found.timing.latency_ms);
  CHECK(read_estimates(folder / "poses", 1).poses.count(3) == 0);
}

TEST_CASE("frames tell how often poses come, and how late") {
  temp_folder folder{"poses", R"({"stamp": 10.0, "age_ms": 7, "tags": []}
{"stamp": 10.1, "age_ms": 9, "tags": []}
{"stamp": 10.4, "age_ms": 90, "tags": []}
)"};
  auto timing = read_estimates(folder / "poses", 0).timing;
  CHECK(timing.rate_hz.value() == Approx(5));
  CHECK(timing.latency_ms.value() == Approx(9));
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
  auto scene =
      compare("scene_1", truth, {{{1, {at(1.01)}}, {9, {at(1)}}}, {5, 12}});
  scene.node = "arm";
  CHECK_THAT(tag_table(scene), Contains("not found") && Contains("1.000")
                                   && Contains("9  is not in the scene"));
  auto text = scene_table({scene});
  CHECK_THAT(text, Contains("all") && Contains("arm") && Contains("1 of 2")
                       && Contains("10.00") && Contains("5.0")
                       && Contains("12.0")
                       && Contains("scene_1: not found: 2\n")
                       && Contains("scene_1: not in the scene: 9\n"));
}

TEST_CASE("no row of scenes is wider than a terminal of 80 columns") {
  true_poses truth;
  for (int id = 0; id < 1000; ++id)
    truth.emplace(id, at(1));
  auto scene = compare("a scene with a long name", truth,
                       {{{1, {at(-5)}}}, {1000, 100'000}});
  scene.node = "a-node-with-a-long-name";
  std::istringstream rows{scene_table({scene})};
  for (std::string line; std::getline(rows, line);)
    CHECK(line.size() <= 80);
}

TEST_CASE("errors of a scene are means, its verdict goes by medians") {
  true_poses truth{{1, at(1)}, {2, at(1)}, {3, at(1)}};
  estimates estimated{{{1, {at(1.001)}}, {2, {at(1.001)}}, {3, {at(1.01)}}},
                      {}};
  auto scene = compare("scene", truth, estimated);
  CHECK_THAT(scene_table({scene}), Contains(" 4.00 "));
  CHECK_THAT(verdict(summarize({scene}), limit),
             Contains("median errors 0.100 %") && Contains(": good"));
  CHECK_THAT(verdict(summarize({scene}), {0.01, 2}), Contains("NOT GOOD"));
}
