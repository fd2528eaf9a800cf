#include "test/actors/fakes/coordinator_fakes.hpp"

/// What a cell makes of it that a node has other skills while it is a member.
namespace roscell::test {

namespace {

/// Another build of the skill `echo`.
installed_skill edited_echo() {
  auto result = echo_skill();
  result.hash = std::string(64, 'e');
  return result;
}

struct skilled_cell : paper_cell {
  fake_agent& arm = add("arm");

  void report(fake_agent& x, std::vector<installed_skill> skills) {
    x.skills = std::move(skills);
    caf::anon_send(coordinator, member_skills_changed{
                                    x.identity.uuid, x.member, {x.skills, {}}});
    time.settle();
  }

  json skills() {
    return request({{"type", "skill_query"}});
  }
};

} // namespace

TEST_CASE_METHOD(skilled_cell,
                 "A build that a member has got is placed at once",
                 "[cell_skills]") {
  base.has.cpu.used = 4;
  report(arm, {edited_echo()});
  CHECK(skills().at("skills").size() == 2);
  REQUIRE(count("skill_removed") == 1);
  REQUIRE(count("skill_added") == 1);
  CHECK(events.back().what == "skill_added");
  CHECK(events.back().subject == "echo");
  CHECK(events.back().data
        == json{{"node", "arm"},
                {"hash", edited_echo().hash},
                {"version", edited_echo().version}});
  const auto reply = request(echo_task("t", {echo_step("s0", 1, "arm")}));
  REQUIRE(reply.at("type") == "task_accepted");
  REQUIRE(arm.deployments.size() == 1);
  CHECK(arm.deployments[0].skill == edited_echo().hash);
}

TEST_CASE_METHOD(skilled_cell, "What runs of a build that has gone runs on",
                 "[cell_skills]") {
  request(echo_task("t", {echo_step("s0", 1, "arm")}));
  REQUIRE(arm.running.size() == 1);
  report(arm, {edited_echo()});
  time.advance(10s);
  CHECK(arm.running.size() == 1);
  CHECK(arm.removals.empty());
  CHECK(row("arm").state == row_state::active);
}

TEST_CASE_METHOD(skilled_cell, "The same skills again are no event",
                 "[cell_skills]") {
  report(arm, {edited_echo()});
  const auto before = events.size();
  report(arm, {edited_echo()});
  CHECK(events.size() == before);
}

TEST_CASE_METHOD(skilled_cell,
                 "What an earlier session says of skills is "
                 "ignored",
                 "[cell_skills]") {
  auto& again = make_agent("arm");
  again.identity.epoch = 2;
  REQUIRE(enter(again));
  report(arm, {edited_echo()});
  CHECK(skills().at("skills").size() == 1);
  CHECK(count("skill_added") == 0);
  report(again, {edited_echo()});
  CHECK(count("skill_added") == 1);
}

TEST_CASE_METHOD(skilled_cell, "A problem that is fixed is gone from the list",
                 "[cell_skills]") {
  const skill_problem half{"/skills/half/skill.json", "", "is half copied"};
  caf::anon_send(coordinator, member_skills_changed{arm.identity.uuid,
                                                    arm.member,
                                                    {arm.skills, {half}}});
  time.settle();
  CHECK(skills().at("refused").at(0).at("node") == "arm");
  report(arm, arm.skills);
  CHECK_FALSE(skills().contains("refused"));
}

TEST_CASE_METHOD(skilled_cell,
                 "The coordinator's own node has other skills, "
                 "too",
                 "[cell_skills]") {
  caf::anon_send(coordinator, skills_changed{{edited_echo()}, {}});
  time.settle();
  CHECK(skills().at("skills").size() == 2);
  // Its node tells of it by itself, in the same log.
  CHECK(count("skill_added") == 0);
}

TEST_CASE_METHOD(skilled_cell,
                 "A lost step that no node has the skill of is placed as soon "
                 "as one has",
                 "[cell_skills]") {
  auto& left = add("left");
  base.has.cpu.used = 4;
  arm.has.cpu.used = 4;
  auto step = echo_step("s0", 1);
  step["on_node_loss"] = {{"policy", "move"}, {"after_s", 30}};
  REQUIRE(request(echo_task("t", {step})).at("type") == "task_accepted");
  REQUIRE(left.running.size() == 1);
  arm.has.cpu.used = 0;
  report(arm, {});
  caf::anon_send(coordinator, skills_changed{});
  lose(left);
  // By then the pauses between attempts are long.
  time.advance(5min);
  CHECK(arm.running.empty());
  REQUIRE(count("step_stranded") == 1);
  report(arm, {edited_echo()});
  time.advance(100ms);
  REQUIRE(arm.running.size() == 1);
  CHECK(arm.running.begin()->second.spec.skill == edited_echo().hash);
}

} // namespace roscell::test
