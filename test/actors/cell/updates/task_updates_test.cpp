#include "actors/core/ros2_setting.hpp"
#include "test/actors/fakes/careful_cell.hpp"

#include <algorithm>
#include <map>

/// How a task that runs is changed: what differs is replaced, and put back
/// where it does not run well.
namespace roscell::test {

namespace {

/// A step that is another one for another `version`.
json versioned(json step, int version) {
  step["env"] = {{"VERSION", std::to_string(version)}};
  return step;
}

struct changing_cell : careful_cell {
  static json task(const std::vector<json>& steps) {
    return echo_task("a", steps);
  }

  /// "s0" on the left, "s1" on the right.
  static json two_steps(int first, int second) {
    return task({versioned(echo_step("s0", 1, "left"), first),
                 versioned(echo_step("s1", 1, "right"), second)});
  }

  /// A step that has to be stop-safe, on the left.
  static json grasp(int version) {
    return task({versioned(grasp_step("s0", "left"), version)});
  }

  json update(json document, const json& options = json::object()) {
    document["type"] = "task_update";
    document.update(options);
    return request(document);
  }

  void run(const json& document) {
    REQUIRE(request(document).at("type") == "task_accepted");
  }

  /// Long enough for one wave to settle.
  void settle() {
    time.advance(11s);
  }

  json row() {
    return task_of("a");
  }

  std::string updating() {
    return row().value("updating", "");
  }

  std::string problem() {
    return row().value("update_problem", "");
  }

  int64_t revision() {
    return row().value("revision", 1);
  }

  static std::string version_on(const fake_agent& node,
                                const std::string& step) {
    for (const auto& [id, row] : node.running)
      if (row.spec.step == step)
        return row.spec.environment.at("VERSION");
    return "";
  }

  static json change_of(const json& plan, const std::string& step) {
    for (const auto& x : plan.at("changes"))
      if (x.at("step") == step)
        return x;
    return {};
  }

  /// An instance ends by itself, and its node starts it again later.
  void break_down(fake_agent& node, const std::string& instance) {
    auto& row = node.running.at(instance);
    row.state = instance_state::backing_off;
    row.reason = "it exited with code 3";
    node.report_row(row);
    time.settle();
  }
};

} // namespace

TEST_CASE_METHOD(changing_cell, "A task that does not differ is left alone",
                 "[task_updates]") {
  run(two_steps(1, 1));
  const auto kept = disk.at("a");
  const auto reply = update(two_steps(1, 1));
  CHECK(reply.at("outcome") == "unchanged");
  CHECK(reply.at("changes").size() == 2);
  CHECK(change_of(reply, "s0").at("action") == "stays");
  settle();
  CHECK(disk.at("a") == kept);
  CHECK(left.deployments.size() == 1);
  CHECK(left.removals.empty());
  CHECK(count("task_update_begun") == 0);
}

TEST_CASE_METHOD(changing_cell,
                 "Whether ROS 2 may set parameters is told to what starts, and "
                 "changes no step",
                 "[task_updates]") {
  run(two_steps(1, 1));
  const auto is_let_in = [](const fake_agent& node) {
    return lets_ros2_set_parameters(node.running.begin()->second.spec);
  };
  CHECK_FALSE(is_let_in(left));
  ros2_set_parameters = true;
  begin_anew();
  REQUIRE(enter(left));
  REQUIRE(enter(right));
  CHECK(update(two_steps(1, 1)).at("outcome") == "unchanged");
  CHECK(update(two_steps(2, 1)).at("outcome") == "begun");
  settle();
  CHECK(is_let_in(left));
  CHECK_FALSE(is_let_in(right));
  // And no more where the cell does not let it.
  ros2_set_parameters = false;
  begin_anew();
  REQUIRE(enter(left));
  REQUIRE(enter(right));
  CHECK(update(two_steps(2, 1)).at("outcome") == "unchanged");
  update(two_steps(3, 1));
  settle();
  CHECK_FALSE(is_let_in(left));
}

TEST_CASE_METHOD(changing_cell,
                 "A step that differs is replaced on its node, others go on",
                 "[task_updates]") {
  run(two_steps(1, 1));
  const auto stays = on(left, "s0");
  const auto old = on(right, "s1");
  const auto reply = update(two_steps(1, 2));
  REQUIRE(reply.at("outcome") == "begun");
  CHECK(reply.at("revision") == 2);
  CHECK(change_of(reply, "s0").at("action") == "stays");
  const auto change = change_of(reply, "s1");
  CHECK(change.at("action") == "restarts");
  CHECK(change.at("to") == "right");
  CHECK(change.at("reasons") == json{"environment.VERSION"});
  CHECK(right.running.size() == 1);
  CHECK(version_on(right, "s1") == "2");
  CHECK(updating() != "");
  CHECK(revision() == 1);
  settle();
  CHECK(updating() == "");
  CHECK(problem() == "");
  CHECK(revision() == 2);
  CHECK(on(left, "s0") == stays);
  CHECK(left.removals.empty());
  CHECK(row().at("instances").size() == 2);
  CHECK(row().at("state") == "running");
  CHECK(count("step_replaced") == 1);
  CHECK(count("task_updated") == 1);
  // It is what it is now: the same again changes nothing, nor does a restart of
  // the coordinator.
  CHECK(update(two_steps(1, 2)).at("outcome") == "unchanged");
  CHECK(on(right, "s1") != old);
}

TEST_CASE_METHOD(changing_cell,
                 "A step that does not come up puts back all that was replaced",
                 "[task_updates]") {
  run(two_steps(1, 1));
  right.mood = temper::broken;
  REQUIRE(update(two_steps(2, 2)).at("outcome") == "begun");
  CHECK(version_on(left, "s0") == "2");
  right.mood = temper::happy;
  auto fail_second = [&] {
    right.mood = temper::broken;
    settle();
    right.mood = temper::happy;
  };
  fail_second();
  time.advance(2min);
  CHECK(version_on(left, "s0") == "1");
  CHECK(version_on(right, "s1") == "1");
  CHECK(left.running.size() == 1);
  CHECK(right.running.size() == 1);
  CHECK(row().at("state") == "running");
  CHECK(revision() == 1);
  CHECK(problem().find("step 's1' on 'right'") == 0);
  CHECK(count("task_update_reverted") == 1);
  CHECK(count("task_updated") == 0);
}

TEST_CASE_METHOD(changing_cell,
                 "A step that breaks before it has settled is put back",
                 "[task_updates]") {
  run(two_steps(1, 1));
  const auto stays = on(left, "s0");
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  time.advance(5s);
  break_down(right, on(right, "s1"));
  time.advance(1s);
  CHECK(version_on(right, "s1") == "1");
  CHECK(on(left, "s0") == stays);
  CHECK(updating() == "");
  CHECK(problem().find("it exited with code 3") != std::string::npos);
  CHECK(row().at("state") == "running");
}

TEST_CASE_METHOD(changing_cell,
                 "A step that breaks after it has settled is its node's matter",
                 "[task_updates]") {
  run(two_steps(1, 1));
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  settle();
  break_down(right, on(right, "s1"));
  CHECK(version_on(right, "s1") == "2");
  CHECK(revision() == 2);
}

TEST_CASE_METHOD(changing_cell, "How long a step is to run well is said",
                 "[task_updates]") {
  run(two_steps(1, 1));
  auto document = two_steps(1, 2);
  document["update"] = {{"healthy_for_s", 2.5}};
  REQUIRE(update(document).at("outcome") == "begun");
  time.advance(2400ms);
  CHECK(updating() != "");
  time.advance(200ms);
  CHECK(updating() == "");
  CHECK(revision() == 2);
}

TEST_CASE_METHOD(changing_cell,
                 "Upstream steps come first, one after the other",
                 "[task_updates]") {
  // "s0" reads what "s1" writes.
  const auto chain = [](int version) {
    auto source = versioned(echo_step("s1", 1, "left"), version);
    source["output"] = {{"protocol", "file"},
                        {"endpoint", "/srv/x"},
                        {"data_type", "text/plain"}};
    auto sink = versioned(echo_step("s0", 1, "left"), version);
    sink["input"] = source["output"];
    return task({sink, source});
  };
  run(chain(1));
  REQUIRE(update(chain(2)).at("outcome") == "begun");
  CHECK(version_on(left, "s1") == "2");
  CHECK(version_on(left, "s0") == "1");
  time.advance(9s);
  CHECK(version_on(left, "s0") == "1");
  time.advance(2s);
  CHECK(version_on(left, "s0") == "2");
  CHECK(updating() != "");
  settle();
  CHECK(revision() == 2);
}

TEST_CASE_METHOD(changing_cell, "Steps come and go with a request",
                 "[task_updates]") {
  run(task({echo_step("s0", 1, "left"), echo_step("s1", 1, "right")}));
  const auto reply =
      update(task({echo_step("s2", 1, "left"), echo_step("s0", 1, "left")}));
  REQUIRE(reply.at("outcome") == "begun");
  CHECK(change_of(reply, "s2").at("action") == "starts");
  CHECK(change_of(reply, "s0").at("action") == "stays");
  CHECK(change_of(reply, "s1").at("action") == "stops");
  CHECK_FALSE(on(right, "s1").empty());
  settle();
  CHECK(right.running.empty());
  CHECK(left.running.size() == 2);
  const auto instances = row().at("instances");
  REQUIRE(instances.size() == 2);
  CHECK(revision() == 2);
  CHECK(disk.at("a").at("specs").at(0).at("step") == "s2");
}

TEST_CASE_METHOD(changing_cell, "A change that has no place changes nothing",
                 "[task_updates]") {
  run(two_steps(1, 1));
  const auto kept = disk.at("a");
  auto document = two_steps(1, 2);
  document["pipeline"].push_back(echo_step("s2", 4, "right"));
  CHECK(error_of(update(document)) == "no_feasible_allocation");
  CHECK(disk.at("a") == kept);
  CHECK(left.removals.empty());
  CHECK(right.removals.empty());
  CHECK(updating() == "");
  // Nothing of it is in the way of the next one.
  CHECK(update(two_steps(1, 2)).at("outcome") == "begun");
}

TEST_CASE_METHOD(changing_cell,
                 "What is replaced makes room for what replaces it",
                 "[task_updates]") {
  run(task({versioned(echo_step("s0", 4, "left"), 1)}));
  REQUIRE(update(task({versioned(echo_step("s0", 4, "left"), 2)})).at("outcome")
          == "begun");
  settle();
  CHECK(version_on(left, "s0") == "2");
  CHECK(revision() == 2);
}

TEST_CASE_METHOD(changing_cell,
                 "A step that needs the room of another waits for its end",
                 "[task_updates]") {
  run(task({versioned(echo_step("s0", 3, "left"), 1),
            versioned(echo_step("s1", 1, "left"), 1)}));
  REQUIRE(update(task({versioned(echo_step("s0", 1, "left"), 2),
                       versioned(echo_step("s1", 3, "left"), 2)}))
              .at("outcome")
          == "begun");
  time.advance(30s);
  CHECK(revision() == 2);
  CHECK(left.running.size() == 2);
}

TEST_CASE_METHOD(changing_cell, "A step goes where its labels are now",
                 "[task_updates]") {
  run(two_steps(1, 1));
  const auto reply = update(task({versioned(echo_step("s0", 1, "left"), 1),
                                  versioned(echo_step("s1", 1, "left"), 1)}));
  REQUIRE(reply.at("outcome") == "begun");
  const auto change = change_of(reply, "s1");
  CHECK(change.at("action") == "moves");
  CHECK(change.at("from") == "right");
  CHECK(change.at("to") == "left");
  settle();
  CHECK(right.running.empty());
  CHECK(left.running.size() == 2);
}

TEST_CASE_METHOD(changing_cell, "What would be done is shown, and not done",
                 "[task_updates]") {
  run(two_steps(1, 1));
  const auto reply = update(two_steps(1, 2), {{"dry_run", true}});
  CHECK(reply.at("outcome") == "shown");
  CHECK(reply.at("revision") == 2);
  CHECK(change_of(reply, "s1").at("action") == "restarts");
  CHECK(change_of(reply, "s1").at("to") == "right");
  settle();
  CHECK(version_on(right, "s1") == "1");
  CHECK(right.removals.empty());
  CHECK(right.reservations.size() == 1);
  CHECK(revision() == 1);
}

TEST_CASE_METHOD(changing_cell,
                 "What changes no instance is written down at once",
                 "[task_updates]") {
  run(two_steps(1, 1));
  auto document = two_steps(1, 1);
  document["timeout_s"] = 60;
  document["labels"] = {{"line", "3"}};
  const auto reply = update(document);
  CHECK(reply.at("outcome") == "begun");
  CHECK(reply.at("reasons")
        == json{"labels.line: none -> 3", "timeout_s: none -> 60.0"});
  time.advance(10ms);
  CHECK(revision() == 2);
  CHECK(row().at("labels").at("line") == "3");
  CHECK(row().at("deadline_unix_ms") > 0);
  CHECK(left.removals.empty());
}

TEST_CASE_METHOD(changing_cell, "What is not stop-safe is waited for",
                 "[task_updates]") {
  run(grasp(1));
  const auto old = on(left, "s0");
  left.not_stop_safe.insert(old);
  REQUIRE(update(grasp(2)).at("outcome") == "begun");
  time.advance(5min);
  CHECK(on(left, "s0") == old);
  CHECK(left.deployments.size() == 1);
  left.become_stop_safe(old);
  time.settle();
  settle();
  CHECK(version_on(left, "s0") == "2");
  CHECK(revision() == 2);
}

TEST_CASE_METHOD(changing_cell,
                 "What stays not stop-safe runs on, and its change is put back",
                 "[task_updates]") {
  run(grasp(1));
  const auto old = on(left, "s0");
  left.not_stop_safe.insert(old);
  REQUIRE(update(grasp(2)).at("outcome") == "begun");
  time.advance(11min);
  CHECK(on(left, "s0") == old);
  CHECK(updating() == "");
  CHECK(problem().find("not stop-safe") != std::string::npos);
  CHECK(left.deployments.size() == 1);
}

TEST_CASE_METHOD(changing_cell, "One change of a task goes on at a time",
                 "[task_updates]") {
  run(two_steps(1, 1));
  const auto first = update(two_steps(1, 2));
  REQUIRE(first.at("outcome") == "begun");
  // The same once more hears the same, as after an answer that was lost.
  CHECK(update(two_steps(1, 2)) == first);
  CHECK(error_of(update(two_steps(1, 3))) == "conflict");
  CHECK(error_of(request({{"type", "task_restart"}, {"task", "a"}}))
        == "conflict");
  settle();
  CHECK(revision() == 2);
  CHECK(right.deployments.size() == 2);
}

TEST_CASE_METHOD(changing_cell, "A task that is stopped is changed no more",
                 "[task_updates]") {
  run(two_steps(1, 1));
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  REQUIRE(request(termination("a")).at("type") == "task_terminated");
  CHECK(left.running.empty());
  CHECK(right.running.empty());
  CHECK(disk.empty());
  // Another one of its name is another one.
  run(two_steps(7, 7));
  const auto kept = disk.at("a");
  time.advance(1min);
  CHECK(disk.at("a") == kept);
  CHECK(version_on(right, "s1") == "7");
  CHECK(update(two_steps(7, 8)).at("outcome") == "begun");
}

TEST_CASE_METHOD(changing_cell,
                 "A task that is stopped while a step starts leaves nothing",
                 "[task_updates]") {
  run(two_steps(1, 1));
  right.mood = temper::slow;
  const auto begun = post([&] {
    auto document = two_steps(1, 2);
    document["type"] = "task_update";
    return document;
  }());
  REQUIRE(reply_of(begun).at("outcome") == "begun");
  REQUIRE(request(termination("a")).at("type") == "task_terminated");
  right.finish_starting();
  time.settle();
  time.advance(2min);
  CHECK(left.running.empty());
  CHECK(right.running.empty());
  CHECK(disk.empty());
}

TEST_CASE_METHOD(changing_cell,
                 "A coordinator that ends during a change puts it back",
                 "[task_updates]") {
  run(two_steps(1, 1));
  const auto stays = on(left, "s0");
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  time.advance(3s);
  begin_anew();
  REQUIRE(enter(left));
  REQUIRE(enter(right));
  time.advance(1min);
  CHECK(on(left, "s0") == stays);
  CHECK(version_on(right, "s1") == "1");
  CHECK(right.running.size() == 1);
  CHECK(row().at("state") == "running");
  CHECK(revision() == 1);
  CHECK(problem() == "the coordinator ended while the task was updated");
  // The next one goes well, and says so.
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  settle();
  CHECK(problem() == "");
  CHECK(revision() == 2);
}

TEST_CASE_METHOD(changing_cell,
                 "A coordinator that ends after a change knows the new task",
                 "[task_updates]") {
  run(two_steps(1, 1));
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  settle();
  const auto fresh = on(right, "s1");
  begin_anew();
  REQUIRE(enter(left));
  REQUIRE(enter(right));
  time.advance(1min);
  CHECK(on(right, "s1") == fresh);
  CHECK(revision() == 2);
  CHECK(update(two_steps(1, 2)).at("outcome") == "unchanged");
}

TEST_CASE_METHOD(changing_cell, "A node that is lost during a change ends it",
                 "[task_updates]") {
  run(two_steps(1, 1));
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  time.advance(2s);
  lose(right);
  settle();
  CHECK(updating() == "");
  CHECK(problem() != "");
  REQUIRE(enter(right));
  time.advance(2min);
  CHECK(version_on(right, "s1") == "1");
  CHECK(right.running.size() == 1);
  CHECK(row().at("state") == "running");
}

TEST_CASE_METHOD(changing_cell,
                 "What is on a node that is away cannot be replaced",
                 "[task_updates]") {
  run(two_steps(1, 1));
  lose(right);
  CHECK(error_of(update(two_steps(1, 2))) == "conflict");
  // What is elsewhere can.
  REQUIRE(update(two_steps(2, 1)).at("outcome") == "begun");
  settle();
  CHECK(version_on(left, "s0") == "2");
  REQUIRE(enter(right));
  CHECK(version_on(right, "s1") == "1");
}

TEST_CASE_METHOD(changing_cell,
                 "A task that has ended changes with its next run",
                 "[task_updates]") {
  run(task({versioned(echo_step("s0", 1, "left"), 1)}));
  finish(left, on(left, "s0"));
  REQUIRE(row().at("state") == "finished");
  CHECK(update(task({versioned(echo_step("s0", 1, "left"), 1)})).at("outcome")
        == "ended");
  auto document = task({versioned(echo_step("s0", 1, "left"), 2)});
  CHECK(update(document).at("outcome") == "next_run");
  CHECK(left.running.empty());
  document["request_id"] = "next";
  CHECK(error_of(request(document)) == "task_exists");
  document["replace"] = true;
  document["request_id"] = "really";
  const auto reply = request(document);
  REQUIRE(reply.at("type") == "task_accepted");
  CHECK(reply.at("run") == 2);
  CHECK(version_on(left, "s0") == "2");
  CHECK(revision() == 2);
}

TEST_CASE_METHOD(changing_cell, "A task that runs is not replaced unasked",
                 "[task_updates]") {
  run(two_steps(1, 1));
  auto document = two_steps(1, 2);
  document["replace"] = true;
  CHECK(error_of(request(document)) == "task_exists");
  CHECK(version_on(right, "s1") == "1");
}

TEST_CASE_METHOD(changing_cell,
                 "Every step is restarted where that is asked for",
                 "[task_updates]") {
  run(two_steps(1, 1));
  const auto first = on(left, "s0");
  const auto second = on(right, "s1");
  REQUIRE(update(two_steps(1, 1), {{"restart_all", true}}).at("outcome")
          == "begun");
  time.advance(25s);
  CHECK(on(left, "s0") != first);
  CHECK(on(right, "s1") != second);
  CHECK(revision() == 2);
}

TEST_CASE_METHOD(changing_cell, "The last requests of a task are kept",
                 "[task_updates]") {
  run(two_steps(1, 1));
  for (int i = 2; i <= 8; ++i) {
    REQUIRE(update(two_steps(1, i)).at("outcome") == "begun");
    settle();
  }
  const auto known = request({{"type", "task_revisions_query"}, {"task", "a"}})
                         .at("revisions");
  REQUIRE(known.size() == 5);
  CHECK(known.at(0).at("revision") == 4);
  CHECK(known.at(4).at("revision") == 8);
  CHECK(known.at(0).at("request").at("pipeline").at(1).at("env").at("VERSION")
        == "4");
  CHECK(known.at(4).at("builds").at("s1") == echo_skill().hash);
}

TEST_CASE_METHOD(changing_cell,
                 "A step that has ended is started if it differs",
                 "[task_updates]") {
  run(two_steps(1, 1));
  finish(right, on(right, "s1"));
  CHECK(update(two_steps(1, 1)).at("outcome") == "unchanged");
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  settle();
  CHECK(version_on(right, "s1") == "2");
  CHECK(row().at("state") == "running");
  CHECK(row().at("instances").size() == 2);
}

TEST_CASE_METHOD(changing_cell, "A new step that has done its work is well",
                 "[task_updates]") {
  run(two_steps(1, 1));
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  finish(right, on(right, "s1"));
  settle();
  CHECK(revision() == 2);
  CHECK(problem() == "");
  CHECK(row().at("state") == "running");
  finish(left, on(left, "s0"));
  CHECK(row().at("state") == "finished");
}

TEST_CASE_METHOD(changing_cell,
                 "A task whose steps all end while it changes is over then",
                 "[task_updates]") {
  run(two_steps(1, 1));
  auto& row_of_second = right.running.at(on(right, "s1"));
  row_of_second.state = instance_state::failed;
  row_of_second.exit_code = 3;
  right.report_row(row_of_second);
  time.settle();
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  finish(left, on(left, "s0"));
  for (const auto& [id, x] : std::map{right.running})
    if (x.state == instance_state::running)
      finish(right, id);
  settle();
  CHECK(updating() == "");
  CHECK(revision() == 2);
  CHECK(row().at("state") == "finished");
  CHECK(row().at("instances").size() == 2);
}

TEST_CASE_METHOD(changing_cell, "A full disk lets a task as it is",
                 "[task_updates]") {
  run(two_steps(1, 1));
  disk_full = true;
  CHECK(error_of(update(two_steps(1, 2))) != "");
  CHECK(version_on(right, "s1") == "1");
  disk_full = false;
  CHECK(updating() == "");
  REQUIRE(update(two_steps(1, 2)).at("outcome") == "begun");
  disk_full = true;
  settle();
  disk_full = false;
  time.advance(1min);
  CHECK(version_on(right, "s1") == "1");
  CHECK(revision() == 1);
  CHECK(row().at("state") == "running");
}

TEST_CASE_METHOD(changing_cell, "A node is not drained while its task changes",
                 "[task_updates]") {
  run(task({versioned(echo_step("s0", 1), 1)}));
  auto& node = left.running.empty() ? right : left;
  auto& other = left.running.empty() ? left : right;
  REQUIRE(update(task({versioned(echo_step("s0", 1), 2)})).at("outcome")
          == "begun");
  request({{"type", "node_drain"}, {"node", node.identity.name}});
  settle();
  CHECK(revision() == 2);
  time.advance(2min);
  CHECK(node.running.empty());
  CHECK(version_on(other, "s0") == "2");
}

TEST_CASE_METHOD(changing_cell,
                 "A change of a task that is not there is refused",
                 "[task_updates]") {
  CHECK(error_of(update(two_steps(1, 1))) == "unknown_task");
  CHECK(error_of(request({{"type", "task_revisions_query"}, {"task", "a"}}))
        == "unknown_task");
}

} // namespace roscell::test
