#include "actors/cell/limits.hpp"
#include "test/actors/fakes/crowded_cell.hpp"

/// Running steps that move to where the cell is better balanced.
namespace roscell::test {

namespace {

struct uneven_cell : crowded_cell {
  uneven_cell() {
    right.has.cpu.used = 4;
    for (const auto* task : {"c", "d"})
      REQUIRE(request(echo_task(task, {echo_step("s0", 1)})).at("type")
              == "task_accepted");
    REQUIRE(left.running.size() == 4);
    right.has.cpu.used = 0;
  }

  static json rebalance(const json& more = json::object()) {
    json result{{"type", "cell_rebalance"}};
    result.update(more);
    return result;
  }

  /// The instance that was moved first, as its node knows it.
  instance_row moved() {
    return right.running.begin()->second;
  }
};

} // namespace

TEST_CASE_METHOD(uneven_cell, "A dry run shows the moves and makes none",
                 "[rebalance]") {
  const auto reply = request(rebalance({{"dry_run", true}}));
  REQUIRE(reply.at("type") == "cell_rebalanced");
  CHECK(reply.at("running") == false);
  REQUIRE(reply.at("moves").size() == 2);
  double gains = 0;
  for (const auto& x : reply.at("moves")) {
    CHECK(x.at("from") == "left");
    CHECK(x.at("to") == "right");
    gains += x.at("gain").get<double>();
  }
  CHECK(gains
        == Approx(reply.at("before").get<double>()
                  - reply.at("after").get<double>()));
  CHECK(reply.at("optimal") == true);
  time.advance(5min);
  CHECK(left.running.size() == 4);
}

TEST_CASE_METHOD(uneven_cell,
                 "Moves are made one by one, each healthy before the next",
                 "[rebalance]") {
  const auto reply = request(rebalance());
  CHECK(reply.at("running") == true);
  time.settle();
  CHECK(right.running.size() == 1);
  // The same request again tells how far it is.
  CHECK(request(rebalance()).at("moves")[0].at("state") == "settling");
  time.advance(limits::task::healthy_for - 1s);
  CHECK(right.running.size() == 1);
  time.advance(1s);
  CHECK(right.running.size() == 2);
  CHECK(count("rebalance_ended") == 0);
  time.advance(limits::task::healthy_for);
  CHECK(left.running.size() == 2);
  CHECK(count("rebalance_ended") == 1);
  CHECK(count("instance_moved") == 2);
  // There is nothing more to gain.
  CHECK(request(rebalance()).at("moves").empty());
}

TEST_CASE_METHOD(uneven_cell,
                 "A moved instance that does not do well is the last",
                 "[rebalance]") {
  request(rebalance());
  time.settle();
  auto row = moved();
  SECTION("unhealthy") {
    row.health = instance_health::unhealthy;
    row.health_reason = "output 'o' goes at 0 Hz";
    right.report_row(row);
    time.settle();
  }
  SECTION("backing off") {
    row.state = instance_state::backing_off;
    right.report_row(row);
    time.settle();
  }
  SECTION("starved when it should have settled") {
    row.health = instance_health::starved;
    row.health_reason = "input 'i' has no frames";
    right.report_row(row);
    time.settle();
    CHECK(count("rebalance_ended") == 0);
    time.advance(limits::task::healthy_for);
  }
  CHECK(count("rebalance_ended") == 1);
  time.advance(5min);
  CHECK(right.running.size() == 1);
}

TEST_CASE_METHOD(uneven_cell, "A move that fails is the last", "[rebalance]") {
  right.mood = temper::broken;
  request(rebalance());
  time.settle();
  CHECK(count("rebalance_ended") == 1);
  CHECK(left.running.size() == 4);
  CHECK(tasks()[0].at("state") == "running");
}

TEST_CASE_METHOD(uneven_cell, "Who stops the moves has the present one ended",
                 "[rebalance]") {
  request(rebalance());
  time.settle();
  CHECK(request(rebalance({{"stop", true}})).at("running") == true);
  time.advance(5min);
  CHECK(right.running.size() == 1);
  CHECK(count("rebalance_ended") == 1);
  CHECK(request(rebalance({{"stop", true}})).at("trouble") == "it was stopped");
}

TEST_CASE_METHOD(uneven_cell, "A node that is drained gets nothing",
                 "[rebalance]") {
  request({{"type", "node_drain"}, {"node", "right"}});
  CHECK(request(rebalance()).at("moves").empty());
}

TEST_CASE_METHOD(uneven_cell, "Nonsense is refused with its place",
                 "[rebalance]") {
  for (const auto& wrong :
       {json{{"min_gain", -1}}, json{{"min_gain", 0}}, json{{"most_moves", 0}},
        json{{"most_moves", 257}}}) {
    const auto reply = request(rebalance(wrong));
    CHECK(error_of(reply) == "schema_violation");
    CHECK(reply.at("error").at("where") == "/" + wrong.begin().key());
  }
}

TEST_CASE(
    "A step that has to be stop-safe ends before its successor starts, in a "
    "rebalance too",
    "[rebalance]") {
  paper_cell cell;
  cell.base.has.cpu.used = 4;
  auto& left = cell.make_agent("left");
  auto& right = cell.make_agent("right");
  for (auto* x : {&left, &right}) {
    x->skills = {grasp_skill()};
    REQUIRE(cell.enter(*x));
  }
  right.has.cpu.used = 4;
  for (const auto* task : {"a", "b"}) {
    auto step = echo_step("s0", 2);
    step["operation"] = "grasp";
    REQUIRE(cell.request(echo_task(task, {step})).at("type")
            == "task_accepted");
  }
  right.has.cpu.used = 0;
  for (const auto& [instance, row] : left.running)
    left.not_stop_safe.insert(instance);
  const auto reply = cell.request({{"type", "cell_rebalance"}});
  REQUIRE(reply.at("moves").size() == 1);
  cell.time.advance(5min);
  CHECK(right.running.empty());
  left.become_stop_safe(reply.at("moves")[0].at("instance").get<std::string>());
  cell.time.settle();
  CHECK(right.running.size() == 1);
}

} // namespace roscell::test
