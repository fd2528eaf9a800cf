#include "test/actors/fakes/coordinator_fakes.hpp"

/// How a request finds its task, and when that runs once more.
namespace roscell::test {

namespace {

json under(const std::string& id, json request) {
  request["request_id"] = id;
  return request;
}

struct job_cell : paper_cell {
  using paper_cell::paper_cell;

  json body() {
    return echo_task("t", {echo_step("s0", 1), echo_step("s1", 1)});
  }

  /// All that runs on the coordination node ends with this code.
  void end_all(int code) {
    for (auto& [instance, row] : base.running) {
      row.state = code == 0 ? instance_state::stopped : instance_state::failed;
      row.exit_code = code;
      base.report_row(row);
    }
    time.settle();
  }

  std::string state() {
    return tasks()[0].at("state");
  }

  task_record kept() const {
    return disk.at("t").get<task_record>();
  }
};

} // namespace

TEST_CASE_METHOD(job_cell, "A job that has ended runs once more under a new id",
                 "[next_run]") {
  const auto code = GENERATE(0, 3);
  const auto first = request(under("one", body()));
  CHECK(first.value("found", "started") == "started");
  end_all(code);
  REQUIRE(state() == (code == 0 ? "finished" : "failed"));
  const auto next = request(under("two", body()));
  REQUIRE(next.at("type") == "task_accepted");
  CHECK(next.at("found") == "anew");
  CHECK(next.at("run") == 2);
  CHECK(state() == "running");
  CHECK(tasks()[0].at("run") == 2);
  // All steps, also those that had ended with 0.
  CHECK(base.deployments.size() == 4);
  for (size_t i = 0; i < 2; ++i)
    CHECK(next.at("instances")[i].at("instance")
          != first.at("instances")[i].at("instance"));
  // What the first run has left is removed.
  CHECK(base.running.size() == 2);
  CHECK(disk.at("t").count("ends") == 0);
  end_all(0);
  CHECK(state() == "finished");
  CHECK(kept().run == 2);
}

TEST_CASE_METHOD(job_cell, "Under one id a job runs once", "[next_run]") {
  request(under("one", body()));
  SECTION("while it runs") {
    const auto again = request(under("one", body()));
    CHECK(again.at("found") == "running");
  }
  SECTION("once it has ended") {
    const auto code = GENERATE(0, 3);
    end_all(code);
    const auto again = request(under("one", body()));
    CHECK(again.at("found") == (code == 0 ? "finished" : "failed"));
    CHECK(again.count("healed") == 0);
  }
  SECTION("also where the id has found it running") {
    CHECK(request(under("two", body())).at("found") == "running");
    end_all(0);
    CHECK(request(under("two", body())).at("found") == "finished");
  }
  SECTION("without an id, too") {
    end_all(0);
    CHECK(request(body()).at("found") == "finished");
  }
  CHECK(base.deployments.size() == 2);
}

TEST_CASE("Under one id a job runs once, also after a coordinator's restart",
          "[next_run]") {
  task_record kept;
  std::vector<instance_row> rows;
  {
    job_cell before;
    before.request(under("one", before.body()));
    before.request(under("two", before.body()));
    before.end_all(0);
    kept = before.kept();
    for (const auto& [instance, row] : before.base.running)
      rows.push_back(row);
  }
  job_cell after{{kept}, rows};
  after.time.settle();
  const auto* id = GENERATE("one", "two");
  CHECK(after.request(under(id, after.body())).at("found") == "finished");
  CHECK(after.base.deployments.empty());
  CHECK(after.request(under("three", after.body())).at("found") == "anew");
  CHECK(after.base.deployments.size() == 2);
}

TEST_CASE_METHOD(job_cell, "A job that is sent twice at once runs once",
                 "[next_run]") {
  const auto* other = GENERATE("one", "two");
  base.mood = temper::slow;
  const auto first = post(under("one", body()));
  const auto second = post(under(other, body()));
  base.finish_starting();
  time.settle();
  CHECK(reply_of(first).at("type") == "task_accepted");
  CHECK(reply_of(second).at("type") == "task_accepted");
  CHECK(base.deployments.size() == 2);
  base.mood = temper::happy;
  end_all(0);
  CHECK(request(under(other, body())).at("found") == "finished");
}

TEST_CASE_METHOD(
    job_cell, "A next run that does not come up leaves the last one as it was",
    "[next_run]") {
  request(under("one", body()));
  end_all(0);
  const auto before = disk.at("t");
  const auto shown = tasks();
  SECTION("a step fails") {
    base.mood = temper::broken;
  }
  SECTION("there is no room") {
    base.has.cpu.used = base.has.cpu.capacity;
  }
  CHECK(error_of(request(under("two", body()))) != "");
  CHECK(state() == "finished");
  CHECK(disk.at("t") == before);
  CHECK(tasks()[0].at("instances") == shown[0].at("instances"));
  // The id has not been used up.
  base.mood = temper::happy;
  base.has.cpu.used = 0;
  CHECK(request(under("two", body())).at("found") == "anew");
  CHECK(state() == "running");
}

TEST_CASE_METHOD(job_cell, "A request is told what of its task does not run",
                 "[next_run]") {
  auto& other = add("other");
  const auto task = echo_task("t", {echo_step("s0", 1, "other")});
  request(task);
  lose(other);
  const auto reply = request(under("two", task));
  CHECK(reply.at("found") == "degraded");
  REQUIRE(reply.at("waits").size() == 1);
  CHECK(reply.at("waits")[0].at("step") == "s0");
  CHECK(reply.at("waits")[0].at("node") == "other");
  CHECK(reply.at("waits")[0].at("reason") == "waits for node 'other'");
  CHECK(other.deployments.size() == 1);
}

TEST_CASE_METHOD(job_cell,
                 "A node that is renamed keeps its steps, and is told",
                 "[next_run]") {
  auto& other = add("other");
  request(echo_task("t", {echo_step("s0", 1, "other")}));
  const auto instance = other.running.begin()->first;
  lose(other);
  other.identity.name = "another";
  ++other.identity.epoch;
  const auto reply = enter(other);
  REQUIRE(reply);
  REQUIRE(reply->verdicts.size() == 1);
  CHECK(reply->verdicts[0].what == verdict::keep);
  time.settle();
  CHECK(state() == "running");
  CHECK(tasks()[0].at("instances")[0].at("node") == "another");
  CHECK(tasks()[0].at("instances")[0].at("spec").at("instance") == instance);
  CHECK(kept().nodes == std::vector<std::string>{"another"});
  CHECK(count("node_renamed") == 1);
}

TEST_CASE("A coordination node that is renamed keeps its steps", "[next_run]") {
  task_record kept;
  std::vector<instance_row> rows;
  {
    job_cell before;
    before.request(before.body());
    kept = before.kept();
    for (const auto& [instance, row] : before.base.running)
      rows.push_back(row);
  }
  for (auto& node : kept.nodes)
    node = "former";
  job_cell after{{kept}, rows};
  after.time.settle();
  CHECK(after.state() == "running");
  CHECK(after.kept().nodes == std::vector<std::string>(2, "base"));
  CHECK(after.base.deployments.empty());
  CHECK(after.base.removals.empty());
  // What its host has interrupted may go on.
  CHECK(after.base.kept.size() == 2);
}

} // namespace roscell::test
