#include "test/actors/fakes/coordinator_fakes.hpp"

/// Parameters that are changed while a step runs.
namespace roscell::test {

namespace {

/// A node whose skill has parameters that can be changed.
struct tuned_cell : paper_cell {
  fake_agent& left = make_agent("left");

  tuned_cell() {
    left.skills = {tuned_skill()};
    REQUIRE(enter(left));
    base.has.cpu.used = 4;
    REQUIRE(request(body()).at("type") == "task_accepted");
    left.changes.clear();
  }

  static installed_skill tuned_skill() {
    auto result = echo_skill();
    result.hash.assign(64, 'c');
    result.descriptor.operation = "tuner";
    result.descriptor.models[0].parameters = R"({
      "gain": {"type": "number", "default": 1, "minimum": 0, "maximum": 9,
               "changeable": true},
      "word": {"type": "string", "default": "a", "changeable": true},
      "size": {"type": "integer", "default": 4}})";
    return result;
  }

  static json body() {
    auto first = tuner_step("s0");
    first["parameters"] = {{"gain", 2}};
    return echo_task("t", {first, tuner_step("s1")});
  }

  static json tuner_step(const std::string& id) {
    auto result = echo_step(id, 1, "left");
    result["operation"] = "tuner";
    return result;
  }

  std::string instance_of(const std::string& step) const {
    for (const auto& [id, row] : left.running)
      if (row.spec.step == step)
        return id;
    return "";
  }

  json change_of(const json& parameters, const std::string& step = "s0") {
    return {{"type", "parameter_change"},
            {"instance", instance_of(step)},
            {"parameters", parameters}};
  }

  json change(const json& parameters) {
    return request(change_of(parameters));
  }

  /// Of a step, as it is on the disk.
  json written(const std::string& step = "s0") const {
    for (const auto& spec : disk.at("t").at("specs"))
      if (spec.at("step") == step)
        return spec.at("parameters");
    return {};
  }

  json requested() const {
    return json::parse(disk.at("t").at("request").get<std::string>())
        .at("pipeline")[0]
        .at("parameters");
  }
};

const json tuned{{"gain", 5}, {"word", "a"}, {"size", 4}};
const json as_it_was{{"gain", 2}, {"word", "a"}, {"size", 4}};

} // namespace

TEST_CASE_METHOD(tuned_cell,
                 "A node has a parameter first, then it is written down",
                 "[parameters]") {
  slow_disk = true;
  const auto reply = post(change_of({{"gain", 5}}));
  time.settle();
  REQUIRE(left.changes.size() == 1);
  CHECK(json::parse(left.changes[0].parameters) == tuned);
  CHECK_FALSE(reply->has_value());
  finish_writes();
  time.settle();
  const auto answer = reply_of(reply);
  REQUIRE(answer.at("type") == "parameters_changed");
  CHECK(answer.at("former") == json{{"gain", 2}});
  CHECK(answer.at("parameters") == tuned);
  CHECK(answer.at("node") == "left");
  CHECK(written() == tuned);
  CHECK(written("s1").at("gain") == 1);
  CHECK(requested() == json{{"gain", 5}});
  CHECK(count("parameters_changed") == 1);
  // Nothing is started again for it, and it is no revision.
  CHECK(left.deployments.size() == 2);
  CHECK(left.removals.empty());
  CHECK(tasks()[0].value("revision", 1) == 1);
}

TEST_CASE_METHOD(tuned_cell, "The same values again cost nothing",
                 "[parameters]") {
  const auto before = disk;
  CHECK(change({{"gain", 2}}).at("type") == "parameters_changed");
  CHECK(left.changes.empty());
  CHECK(disk == before);
  CHECK(count("parameters_changed") == 0);
}

TEST_CASE_METHOD(tuned_cell, "A change that cannot be says why",
                 "[parameters]") {
  const auto unknown = change({{"gainn", 5}});
  CHECK(error_of(unknown) == "schema_violation");
  CHECK(unknown.at("error").at("where") == "/parameters/gainn");
  CHECK(unknown.dump().find("did you mean") != std::string::npos);
  const auto fixed = change({{"size", 5}});
  CHECK(error_of(fixed) == "schema_violation");
  CHECK(fixed.at("error").at("message")
        == "'size' cannot be changed while the skill runs; what can is gain, "
           "word");
  CHECK(error_of(change({{"gain", 10}})) == "schema_violation");
  CHECK(error_of(change({{"gain", "loud"}})) == "schema_violation");
  auto nobody = change_of({{"gain", 5}});
  nobody["instance"] = "t-s0-00000000";
  CHECK(error_of(request(nobody)) == "unknown_task");
  CHECK(left.changes.empty());
}

TEST_CASE_METHOD(tuned_cell, "What does not run is not changed",
                 "[parameters]") {
  auto row = left.running.at(instance_of("s0"));
  row.state = instance_state::backing_off;
  left.report_row(row);
  time.settle();
  const auto reply = change({{"gain", 5}});
  CHECK(error_of(reply) == "conflict");
  CHECK(reply.dump().find("it is backing_off") != std::string::npos);
  lose(left);
  CHECK(error_of(change({{"gain", 5}})) != "");
  CHECK(left.changes.empty());
}

TEST_CASE_METHOD(tuned_cell,
                 "One instance is given other parameters by one at a time",
                 "[parameters]") {
  left.slow_changes = true;
  const auto first = post(change_of({{"gain", 5}}));
  time.settle();
  CHECK(error_of(change({{"gain", 6}})) == "conflict");
  // And nobody starts it again meanwhile.
  CHECK(error_of(request({{"type", "task_restart"}, {"task", "t"}}))
        == "conflict");
  left.finish_changes();
  time.settle();
  CHECK(reply_of(first).at("type") == "parameters_changed");
  left.slow_changes = false;
  CHECK(change({{"gain", 6}}).at("type") == "parameters_changed");
}

TEST_CASE_METHOD(tuned_cell, "What a program refuses stays as it was",
                 "[parameters]") {
  left.slow_changes = true;
  const auto reply = post(change_of({{"gain", 5}}));
  time.settle();
  left.finish_changes(failure{error_code::conflict, "it refuses: too loud"});
  time.settle();
  CHECK(error_of(reply_of(reply)) == "conflict");
  CHECK(left.changes.size() == 1);
  CHECK(written() == as_it_was);
}

TEST_CASE_METHOD(tuned_cell,
                 "What a program may have taken without a word is put back",
                 "[parameters]") {
  left.slow_changes = true;
  const auto reply = post(change_of({{"gain", 5}}));
  time.settle();
  left.finish_changes(failure{error_code::timeout, "no answer"});
  time.settle();
  CHECK(error_of(reply_of(reply)) == "timeout");
  REQUIRE(left.changes.size() == 2);
  CHECK(json::parse(left.changes[1].parameters) == as_it_was);
}

TEST_CASE_METHOD(tuned_cell,
                 "What cannot be written down is put back on the node",
                 "[parameters]") {
  disk_full = true;
  const auto reply = change({{"gain", 5}});
  REQUIRE(reply.at("type") == "error");
  CHECK(reply.dump().find("are put back") != std::string::npos);
  REQUIRE(left.changes.size() == 2);
  CHECK(json::parse(left.changes[1].parameters) == as_it_was);
  disk_full = false;
  CHECK(written() == as_it_was);
  CHECK(change({{"gain", 5}}).at("type") == "parameters_changed");
}

TEST_CASE_METHOD(tuned_cell,
                 "A task that is terminated meanwhile has its last word",
                 "[parameters]") {
  left.slow_changes = true;
  left.slow_removals = true;
  const auto reply = post(change_of({{"gain", 5}}));
  time.settle();
  const auto end = post(termination("t"));
  time.settle();
  left.finish_changes();
  time.settle();
  CHECK(error_of(reply_of(reply)) == "conflict");
  left.finish_removals();
  time.settle();
  CHECK(disk.count("t") == 0);
}

TEST_CASE_METHOD(tuned_cell,
                 "A coordinator that died between tells its node what is "
                 "written down",
                 "[parameters]") {
  slow_disk = true;
  post(change_of({{"gain", 5}}));
  time.settle();
  REQUIRE(left.changes.size() == 1);
  slow_disk = false;
  begin_anew();
  REQUIRE(enter(left));
  time.settle();
  // Both of its instances: it cannot know which.
  REQUIRE(left.changes.size() == 3);
  for (size_t i = 1; i < 3; ++i)
    if (left.changes[i].instance == instance_of("s0"))
      CHECK(json::parse(left.changes[i].parameters) == as_it_was);
}

TEST_CASE_METHOD(tuned_cell,
                 "A node that registers during a change is told its outcome",
                 "[parameters]") {
  slow_disk = true;
  const auto reply = post(change_of({{"gain", 5}}));
  time.settle();
  slow_disk = false;
  left.changes.clear();
  ++left.identity.epoch;
  const auto again = enter(left);
  finish_writes();
  time.settle();
  CHECK(reply_of(reply).at("type") == "parameters_changed");
  REQUIRE_FALSE(left.changes.empty());
  CHECK(left.changes.back().instance == instance_of("s0"));
  CHECK(json::parse(left.changes.back().parameters) == tuned);
}

TEST_CASE_METHOD(tuned_cell,
                 "A step that is started again has the parameters that were "
                 "set",
                 "[parameters]") {
  CHECK(change({{"gain", 5}}).at("type") == "parameters_changed");
  REQUIRE(request({{"type", "task_restart"}, {"task", "t"}}).at("type")
          == "task_restarted");
  bool was_started = false;
  for (size_t i = 2; i < left.deployments.size(); ++i)
    if (left.deployments[i].step == "s0") {
      was_started = true;
      CHECK(json::parse(left.deployments[i].parameters) == tuned);
    }
  CHECK(was_started);
}

} // namespace roscell::test
