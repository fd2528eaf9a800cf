#include "test/actors/fakes/coordinator_fakes.hpp"
#include "test/words.hpp"

#include <algorithm>

/// Sets of tasks in a cell: one task for each node of a kind.
namespace roscell::test {

namespace {

struct fleet : paper_cell {
  fake_agent& robot(const std::string& name) {
    auto& x = make_agent(name);
    x.has.labels["kind"] = "robot";
    REQUIRE(enter(x));
    return x;
  }

  static json patrol(int version = 1) {
    auto step = echo_step("drive", 1);
    step["env"] = {{"VERSION", std::to_string(version)}, {"ON", "${node}"}};
    step["input"] = {{"protocol", "file"},
                     {"endpoint", "/in/${node}"},
                     {"data_type", "text/plain"}};
    return {{"type", "task_set_request"},
            {"task", "patrol"},
            {"for_each", {{"node", {{"labels", {{"kind", "robot"}}}}}}},
            {"pipeline", json::array({step})}};
  }

  json apply(const json& document, const json& more = json::object()) {
    auto request_of_set = document;
    request_of_set.update(more);
    return request(request_of_set);
  }

  json set_row() {
    return request({{"type", "task_query"}, {"task", "patrol"}})
        .at("sets")
        .at(0);
  }

  /// "19 of 20"
  std::string runs_on() {
    const auto row = set_row();
    return std::to_string(row.at("running").get<int>()) + " of "
           + std::to_string(row.at("nodes").get<int>());
  }

  static std::string version_on(const fake_agent& x) {
    return x.running.empty()
               ? ""
               : x.running.begin()->second.spec.environment.at("VERSION");
  }

  static std::string instance_on(const fake_agent& x) {
    REQUIRE(x.running.size() == 1);
    return x.running.begin()->first;
  }

  /// What a node tells that has got other labels.
  void relabel(fake_agent& x, const std::string& kind) {
    x.has.labels["kind"] = kind;
    caf::anon_send(coordinator,
                   member_skills_changed{x.identity.uuid, x.member,
                                         skills_changed{x.skills, {}}});
    time.settle();
  }

  json stop(const std::string& task) {
    return request(termination(task));
  }
};

} // namespace

TEST_CASE_METHOD(fleet, "Each node of the kind gets a task of its own",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  auto& r2 = robot("r2");
  auto& other = add("desk");
  const auto plan = apply(patrol());
  CHECK(plan.at("outcome") == "begun");
  CHECK(plan.at("is_new") == true);
  CHECK(plan.at("changes").size() == 2);
  time.settle();
  for (const auto* x : {&r1, &r2}) {
    REQUIRE(x->running.size() == 1);
    const auto& spec = x->running.begin()->second.spec;
    CHECK(spec.task == "patrol-" + x->identity.name);
    CHECK(spec.environment.at("ON") == x->identity.name);
    CHECK(spec.input.front().endpoint == "/in/" + x->identity.name);
  }
  CHECK(other.running.empty());
  CHECK(base.running.empty());
  CHECK(runs_on() == "2 of 2");
  CHECK(count("set_applied") == 1);
  CHECK(sets.size() == 1);
  for (const auto& row : tasks())
    CHECK(row.at("set") == "patrol");
}

TEST_CASE_METHOD(fleet, "The same set again changes and writes nothing",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  apply(patrol());
  time.settle();
  const auto kept = sets;
  const auto tasks_kept = disk;
  const auto plan = apply(patrol());
  CHECK(plan.at("outcome") == "unchanged");
  CHECK(plan.at("changes").at(0).at("action") == "stays");
  time.advance(1min);
  CHECK(sets == kept);
  CHECK(disk == tasks_kept);
  CHECK(r1.deployments.size() == 1);
}

TEST_CASE_METHOD(fleet, "A set for no node yet runs as 0 of 0", "[task_sets]") {
  const auto plan = apply(patrol());
  CHECK(plan.at("outcome") == "begun");
  CHECK(plan.at("changes").empty());
  CHECK(runs_on() == "0 of 0");
  CHECK(set_row().value("pending", 0) == 0);
  auto& r1 = robot("r1");
  time.settle();
  CHECK(r1.running.size() == 1);
  CHECK(runs_on() == "1 of 1");
}

TEST_CASE_METHOD(fleet, "A plan of a set changes nothing", "[task_sets]") {
  auto& r1 = robot("r1");
  const auto plan = apply(patrol(), {{"dry_run", true}});
  CHECK(plan.at("outcome") == "shown");
  CHECK(plan.at("changes").at(0).at("action") == "starts");
  time.settle();
  CHECK(r1.running.empty());
  CHECK(sets.empty());
  CHECK(error_of(stop("patrol")) == "unknown_task");
}

TEST_CASE_METHOD(fleet,
                 "A task ends where its node loses the label, and begins "
                 "where one gets it",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  auto& other = add("desk");
  apply(patrol());
  time.settle();
  REQUIRE(r1.running.size() == 1);
  relabel(r1, "desk");
  CHECK(r1.running.empty());
  CHECK(runs_on() == "0 of 0");
  CHECK(tasks().empty());
  relabel(other, "robot");
  CHECK(other.running.size() == 1);
  relabel(r1, "robot");
  CHECK(r1.running.size() == 1);
  CHECK(runs_on() == "2 of 2");
}

TEST_CASE_METHOD(fleet,
                 "A node that is lost keeps its task, one that leaves "
                 "does not",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  apply(patrol());
  time.settle();
  const auto instance = instance_on(r1);
  lose(r1);
  time.advance(1min);
  CHECK(runs_on() == "0 of 1");
  ++r1.identity.epoch;
  REQUIRE(enter(r1));
  time.settle();
  CHECK(instance_on(r1) == instance);
  CHECK(runs_on() == "1 of 1");
  request(
      {{"type", "node_release"}, {"node", "r1"}, {"instances", "terminate"}});
  lose(r1);
  time.settle();
  CHECK(runs_on() == "0 of 0");
  CHECK(set_row().count("stopped") == 0);
  CHECK(tasks().empty());
}

TEST_CASE_METHOD(fleet, "A node that is renamed runs the task of its new name",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  apply(patrol());
  time.settle();
  r1.identity.name = "r9";
  r1.has.name = "r9";
  ++r1.identity.epoch;
  REQUIRE(enter(r1));
  time.settle();
  REQUIRE(r1.running.size() == 1);
  CHECK(r1.running.begin()->second.spec.task == "patrol-r9");
  CHECK(r1.running.begin()->second.spec.environment.at("ON") == "r9");
  REQUIRE(tasks().size() == 1);
  CHECK(runs_on() == "1 of 1");
}

TEST_CASE_METHOD(fleet, "A node that is drained has none until it is not",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  apply(patrol());
  time.settle();
  request({{"type", "node_drain"}, {"node", "r1"}});
  time.settle();
  CHECK(r1.running.empty());
  CHECK(runs_on() == "0 of 0");
  request({{"type", "node_undrain"}, {"node", "r1"}});
  time.settle();
  CHECK(r1.running.size() == 1);
}

TEST_CASE_METHOD(fleet,
                 "A set is changed task by task, each well before the "
                 "next",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  auto& r2 = robot("r2");
  apply(patrol());
  time.settle();
  const auto plan = apply(patrol(2));
  CHECK(plan.at("changes").at(0).at("action") == "changes");
  time.settle();
  CHECK(version_on(r1) == "2");
  CHECK(version_on(r2) == "1");
  time.advance(11s);
  CHECK(version_on(r2) == "2");
  time.advance(11s);
  CHECK(runs_on() == "2 of 2");
  CHECK(set_row().value("pending", 0) == 0);
}

TEST_CASE_METHOD(fleet, "A change that is put back goes no further",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  auto& r2 = robot("r2");
  apply(patrol());
  time.settle();
  const auto untouched = instance_on(r2);
  apply(patrol(2));
  time.settle();
  auto& row = r1.running.begin()->second;
  row.state = instance_state::failed;
  row.reason = "it exited with code 3";
  r1.report_row(row);
  time.advance(2min);
  CHECK(version_on(r1) == "1");
  CHECK(instance_on(r2) == untouched);
  const auto stands = set_row();
  REQUIRE(stands.at("problems").size() == 2);
  CHECK(stands.at("problems").at(0).at("node") == "r1");
  CHECK(stands.at("problems").at(1).at("reason")
        == "waits, for the change on 'r1' was put back");
  CHECK(stands.at("pending") == 2);
  // The next request takes it up.
  apply(patrol(3));
  time.advance(30s);
  CHECK(version_on(r1) == "3");
  CHECK(version_on(r2) == "3");
}

TEST_CASE_METHOD(fleet, "What has no room on a node is told and tried again",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  auto& r2 = robot("r2");
  r2.has.cpu.used = 4;
  apply(patrol());
  time.settle();
  CHECK(r1.running.size() == 1);
  CHECK(runs_on() == "1 of 2");
  CHECK(set_row().at("problems").at(0).at("node") == "r2");
  CHECK(count("set_stuck") == 1);
  r2.has.cpu.used = 0;
  time.advance(2min);
  CHECK(r2.running.size() == 1);
  CHECK(runs_on() == "2 of 2");
  CHECK(count("set_stuck") == 1);
}

TEST_CASE_METHOD(fleet, "A set that is stopped ends with all its tasks",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  auto& r2 = robot("r2");
  apply(patrol());
  time.settle();
  const auto reply = stop("patrol");
  CHECK(reply.at("type") == "task_terminated");
  CHECK(reply.at("instances").size() == 2);
  CHECK(r1.running.empty());
  CHECK(r2.running.empty());
  CHECK(sets.empty());
  CHECK(disk.empty());
  time.advance(5min);
  CHECK(tasks().empty());
  CHECK(count("set_removed") == 1);
}

TEST_CASE_METHOD(fleet,
                 "One task that somebody stops stays so until the set is "
                 "applied again",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  auto& r2 = robot("r2");
  apply(patrol());
  time.settle();
  stop("patrol-r1");
  time.advance(5min);
  CHECK(r1.running.empty());
  CHECK(r2.running.size() == 1);
  CHECK(set_row().at("stopped") == json{"r1"});
  begin_anew();
  for (auto* x : {&r1, &r2}) {
    ++x->identity.epoch;
    REQUIRE(enter(*x));
  }
  time.advance(1min);
  CHECK(r1.running.empty());
  CHECK(apply(patrol()).at("outcome") == "begun");
  time.settle();
  CHECK(r1.running.size() == 1);
  CHECK(set_row().count("stopped") == 0);
}

TEST_CASE_METHOD(fleet,
                 "A coordinator that begins anew stops nothing of a set "
                 "before it knows the labels",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  apply(patrol());
  time.settle();
  const auto instance = instance_on(r1);
  begin_anew();
  time.advance(5s);
  CHECK(tasks().size() == 1);
  ++r1.identity.epoch;
  REQUIRE(enter(r1));
  time.advance(1min);
  CHECK(instance_on(r1) == instance);
  CHECK(runs_on() == "1 of 1");
  auto& r2 = robot("r2");
  time.settle();
  CHECK(r2.running.size() == 1);
}

TEST_CASE_METHOD(fleet,
                 "A coordinator that ended while a set was stopped ends "
                 "the rest of it",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  apply(patrol());
  time.settle();
  sets.clear();
  begin_anew();
  ++r1.identity.epoch;
  REQUIRE(enter(r1));
  time.advance(1min);
  CHECK(r1.running.empty());
  CHECK(tasks().empty());
}

TEST_CASE_METHOD(fleet,
                 "What has ended runs once more when the set is run again",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  apply(patrol());
  time.settle();
  auto row = r1.running.begin()->second;
  row.state = instance_state::stopped;
  row.exit_code = 0;
  r1.report_row(row);
  time.advance(1min);
  CHECK(r1.deployments.size() == 1);
  CHECK(runs_on() == "1 of 1");
  CHECK(apply(patrol()).at("outcome") == "unchanged");
  CHECK(apply(patrol(), {{"run_again", true}}).at("outcome") == "begun");
  time.settle();
  CHECK(r1.deployments.size() == 2);
  CHECK(tasks().at(0).at("run") == 2);
}

TEST_CASE_METHOD(fleet,
                 "A set and a task cannot have one name, nor a task a set "
                 "that is not there",
                 "[task_sets]") {
  robot("r1");
  apply(patrol());
  time.settle();
  CHECK(error_of(request(echo_task("patrol", {echo_step("s", 1)})))
        == "conflict");
  REQUIRE(request(echo_task("t", {echo_step("s", 1)})).at("type")
          == "task_accepted");
  auto other = patrol();
  other["task"] = "t";
  CHECK(error_of(apply(other)) == "conflict");
  auto stray = echo_task("u", {echo_step("s", 1)});
  stray["set"] = "none";
  CHECK(error_of(request(stray)) == "conflict");
}

TEST_CASE_METHOD(fleet, "A task of a set is changed by the set alone",
                 "[task_sets]") {
  auto& r1 = robot("r1");
  apply(patrol());
  time.settle();
  auto own = echo_task("patrol-r1", {echo_step("drive", 2)});
  own["type"] = "task_update";
  CHECK(error_of(request(own)) == "conflict");
  CHECK(error_of(request({{"type", "parameter_change"},
                          {"instance", instance_on(r1)},
                          {"parameters", {{"times", 3}}}}))
        == "conflict");
  time.advance(1min);
  CHECK(r1.deployments.size() == 1);
}

TEST_CASE_METHOD(fleet, "A set that is wanted new only does not change another",
                 "[task_sets]") {
  robot("r1");
  apply(patrol());
  time.settle();
  CHECK(error_of(apply(patrol(2), {{"only_new", true}})) == "task_exists");
  CHECK(apply(patrol(1), {{"only_new", true}}).at("outcome") == "unchanged");
}

TEST_CASE_METHOD(fleet, "A set that cannot be read changes nothing",
                 "[task_sets]") {
  robot("r1");
  auto unknown = patrol();
  unknown["pipeline"][0]["operation"] = "fly";
  CHECK(error_of(apply(unknown)) == "unknown_operation");
  auto copies = patrol();
  copies["pipeline"][0]["copies"] = 2;
  copies["pipeline"][0]["output"] = "/out/${node}";
  CHECK(error_of(apply(copies)) == "schema_violation");
  CHECK(sets.empty());
  disk_full = true;
  CHECK(error_of(apply(patrol())) == "internal");
  CHECK(error_of(stop("patrol")) == "unknown_task");
  disk_full = false;
  CHECK(apply(patrol()).at("is_new") == true);
}

TEST_CASE_METHOD(fleet, "Twenty robots get their tasks from one request",
                 "[task_sets]") {
  std::vector<fake_agent*> robots;
  for (int i = 0; i < 20; ++i)
    robots.push_back(&robot("r" + std::to_string(i)));
  apply(patrol());
  time.settle();
  CHECK(runs_on() == "20 of 20");
  for (const auto* x : robots)
    CHECK(x->running.size() == 1);
}

} // namespace roscell::test
