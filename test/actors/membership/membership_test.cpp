#include "actors/edge/session/limits.hpp"
#include "test/actors/fakes/cell_fakes.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

namespace {

using namespace roscell;
using namespace roscell::test;

using membership_test = cell_fixture;

TEST_CASE_METHOD(membership_test, "a node joins the cell of a given server") {
  form_cell();
  const auto status = site.status(node);
  CHECK(status.state == node_state::member);
  CHECK(status.cell == "cell-1");
  CHECK(status.coordinator == "10.0.0.1:8420");
  const auto& row = site.base.rows.at("arm-1");
  CHECK(row.active);
  CHECK(row.identity == status.identity);
  CHECK(row.registration.incarnation == 1);
  REQUIRE(site.events.size() == 1);
  CHECK(site.events[0].what == "cell_joined");
  CHECK(site.events[0].subject == "arm-1");
  CHECK(site.events[0].data["cell"] == "cell-1");
}

TEST_CASE_METHOD(membership_test, "a node joins within 200 ms") {
  site.start_coordinator();
  site.start(node);
  site.join(node);
  // The fake discovery takes 100 of them.
  site.pass(120ms);
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(membership_test, "the raised epoch is stored before its use") {
  form_cell();
  CHECK(node.identity.epoch == 1);
  CHECK(site.base.rows.at("arm-1").identity.epoch == 1);
  cut(*node.link);
  node.disk_full = true;
  site.pass(10s);
  CHECK(state() == node_state::orphaned);
  CHECK(site.base.members.size() == 1);
  node.disk_full = false;
  site.pass(40s);
  CHECK(state() == node_state::member);
  CHECK(node.identity.epoch == 2);
  CHECK(site.base.rows.at("arm-1").identity.epoch == 2);
}

TEST_CASE_METHOD(membership_test, "a node with a wrong token stays independent "
                                  "and asks slowly") {
  site.start_coordinator();
  node.refusal = {error_code::unauthorized, "the site tokens differ"};
  site.start(node);
  site.join(node);
  site.pass(1s);
  CHECK(state() == node_state::independent);
  REQUIRE(site.count("join_refused") == 1);
  CHECK(site.events[0].data["reason"] == "the site tokens differ");
  CHECK_FALSE(node.searching);
  site.pass(28s);
  CHECK(node.searches == 1);
  site.pass(2s);
  CHECK(node.searches == 2);
  // The same refusal again is no news.
  CHECK(site.count("join_refused") == 1);
  node.refusal.reset();
  site.pass(31s);
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(membership_test, "a node whose name is taken stays "
                                  "independent") {
  form_cell();
  auto& twin = site.add_node("arm-1", "b-2");
  site.start(twin);
  site.join(twin);
  site.pass(1s);
  CHECK(site.status(twin).state == node_state::independent);
  REQUIRE(site.count("join_refused") == 1);
  CHECK(site.events.back().data["reason"]
        == "the name 'arm-1' belongs to another node");
  // Its session is gone, the other one's is not.
  CHECK_FALSE(twin.link->open);
  CHECK(state() == node_state::member);
  CHECK(site.base.rows.at("arm-1").active);
}

TEST_CASE_METHOD(membership_test, "a node waits for a coordinator that is not "
                                  "there yet, ever more patiently") {
  site.start(node);
  site.join(node);
  site.pass(4s);
  CHECK(state() == node_state::joining);
  CHECK(node.searching);
  // Each search takes 5 s, the pauses are 0.25, 0.5, ... s at most.
  site.pass(60s);
  CHECK(node.searches >= 7);
  const auto before = node.searches;
  site.pass(600s);
  CHECK(node.searches - before >= 600 / 35);
  CHECK(node.searches - before <= 600 / 20 + 1);
  site.start_coordinator();
  site.pass(36s);
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(membership_test, "a coordinator that appears during a search "
                                  "is joined at once") {
  site.start(node);
  site.join(node);
  site.pass(2s);
  site.start_coordinator();
  site.pass(10ms);
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(membership_test, "what a node runs is in its registration") {
  node.instances = {some_row("t-a-1", "t")};
  node.instances[0].log_tail = "long";
  form_cell();
  const auto& said = site.base.rows.at("arm-1").registration;
  REQUIRE(said.instances.size() == 1);
  CHECK(said.instances[0].spec.instance == "t-a-1");
  CHECK(said.instances[0].log_tail.empty());
  CHECK(said.resources == some_resources("arm-1"));
}

TEST_CASE_METHOD(membership_test, "however long the parameters of what it "
                                  "runs, a node can register") {
  for (int i = 0; i < 12; ++i) {
    node.instances.push_back(some_row("t-a-" + std::to_string(i), "t"));
    node.instances.back().spec.parameters =
        R"({"x":")" + std::string(100'000, 'y') + "\"}";
  }
  form_cell();
  CHECK(state() == node_state::member);
  CHECK(site.base.rows.at("arm-1").registration.instances.size() == 12);
}

TEST_CASE_METHOD(membership_test,
                 "ends that a registration has told are acknowledged") {
  node.instances = {some_row("t-a-1", "t"), some_row("t-b-2", "t")};
  node.instances[1].state = instance_state::stopped;
  form_cell();
  CHECK(node.acknowledged == std::vector<std::string>{"t-b-2"});
}

TEST_CASE_METHOD(membership_test, "verdicts are carried out one by one") {
  node.instances = {some_row("t-a-1", "t"), some_row("t-b-2", "t")};
  site.base.verdicts = {{"t-a-1", verdict::keep, {}},
                        {"t-b-2", verdict::stop, {}},
                        {"t-c-3", verdict::start, {some_spec("t-c-3", "t")}},
                        {"t-d-4", verdict::stop, {}}};
  form_cell();
  REQUIRE(node.removals.size() == 1);
  CHECK(node.removals[0] == instance_removal{"t", "t-b-2"});
  REQUIRE(node.deployments.size() == 1);
  CHECK(node.deployments[0].spec == some_spec("t-c-3", "t"));
}

TEST_CASE_METHOD(membership_test, "the coordinator hears of an instance that "
                                  "it wanted and that cannot be started") {
  site.base.verdicts = {{"t-c-3", verdict::start, {some_spec("t-c-3", "t")}}};
  node.deployment_refusal = {error_code::unknown_operation, "no such skill"};
  form_cell();
  REQUIRE(site.base.changes.size() == 1);
  const auto& row = site.base.changes[0].instance;
  CHECK(row.spec.instance == "t-c-3");
  CHECK(row.state == instance_state::failed);
  CHECK(row.reason == "no such skill");
  CHECK(row.node == "arm-1");
}

TEST_CASE_METHOD(membership_test, "changes of instances reach the "
                                  "coordinator") {
  form_cell();
  auto change = instance_changed{some_row("t-a-1", "t")};
  caf::anon_send(node.membership, change);
  site.pass(1ms);
  REQUIRE(site.base.changes.size() == 1);
  CHECK(site.base.changes[0] == change);
}

TEST_CASE_METHOD(membership_test, "a change during the registration is told "
                                  "after it") {
  site.base.mute = true;
  form_cell();
  CHECK(state() == node_state::joining);
  auto change = instance_changed{some_row("t-a-1", "t")};
  caf::anon_send(node.membership, change);
  site.pass(1s);
  CHECK(site.base.changes.empty());
  REQUIRE(site.base.unanswered.size() == 1);
  caf::anon_send(caf::actor_cast<caf::actor>(site.base.actor), caf::ok_atom_v);
  site.pass(1s);
  CHECK(state() == node_state::member);
  REQUIRE(site.base.changes.size() == 1);
  CHECK(site.base.changes[0] == change);
}

namespace {

skills_changed one_skill() {
  installed_skill skill;
  skill.hash = std::string(64, 'a');
  skill.version = "1";
  skill.descriptor = json::parse(echo_descriptor()).get<skill_descriptor>();
  return {{skill}, {{"/skills/half/skill.json", "", "is half copied"}}};
}

} // namespace

TEST_CASE_METHOD(membership_test, "the coordinator hears of other skills at "
                                  "once, and of all at a registration") {
  form_cell();
  caf::anon_send(node.membership, one_skill());
  site.pass(1ms);
  REQUIRE(site.base.skills.size() == 1);
  CHECK(site.base.skills[0].uuid == node.identity.uuid);
  CHECK(site.base.skills[0].member == site.base.rows.at("arm-1").member);
  CHECK(site.base.skills[0].now == one_skill());
  cut(*node.link);
  site.pass(40s);
  REQUIRE(state() == node_state::member);
  CHECK(site.base.rows.at("arm-1").registration.skills == one_skill().skills);
  CHECK(site.base.rows.at("arm-1").registration.refused_skills
        == one_skill().refused_skills);
  CHECK(site.base.skills.size() == 1);
}

TEST_CASE_METHOD(membership_test, "skills that change during the registration "
                                  "are told after it") {
  site.base.mute = true;
  form_cell();
  CHECK(state() == node_state::joining);
  caf::anon_send(node.membership, one_skill());
  site.pass(1s);
  CHECK(site.base.skills.empty());
  REQUIRE(site.base.unanswered.size() == 1);
  caf::anon_send(caf::actor_cast<caf::actor>(site.base.actor), caf::ok_atom_v);
  site.pass(1s);
  REQUIRE(site.base.skills.size() == 1);
  CHECK(site.base.skills[0].now == one_skill());
}

TEST_CASE_METHOD(membership_test, "a coordinator of an earlier version is told "
                                  "of skills at registrations only") {
  site.base.hears_skills = false;
  form_cell();
  caf::anon_send(node.membership, one_skill());
  site.pass(1s);
  CHECK(site.base.skills.empty());
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(membership_test, "a registration that is not answered is "
                                  "given up within a lease") {
  site.base.mute = true;
  form_cell();
  auto first = node.link;
  site.pass(limits::lease::span);
  CHECK_FALSE(first->open);
  site.base.mute = false;
  site.pass(40s);
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(membership_test, "a node that leaves tells its coordinator") {
  form_cell();
  const auto link = node.link;
  auto reply = time.ask<node_departed>(node.membership, leave_cell{"bye"});
  site.pass(10ms);
  REQUIRE(*reply);
  CHECK((*reply)->engaged());
  CHECK(state() == node_state::independent);
  CHECK(site.base.rows.empty());
  CHECK(site.base.losses.empty());
  CHECK_FALSE(link->open);
  CHECK_FALSE(node.searching);
  CHECK(site.count("cell_left") == 1);
  site.pass(100s);
  CHECK(node.searches == 1);
}

TEST_CASE_METHOD(membership_test, "a node leaves within 2 s also when the "
                                  "coordinator says nothing") {
  form_cell();
  node.link->silent = true;
  auto reply = time.ask<node_departed>(node.membership, leave_cell{"bye"});
  site.pass(1900ms);
  CHECK_FALSE(*reply);
  site.pass(200ms);
  REQUIRE(*reply);
  CHECK((*reply)->engaged());
  CHECK(state() == node_state::independent);
}

TEST_CASE_METHOD(membership_test, "leaving no cell is answered at once") {
  site.start(node);
  auto reply = time.ask<node_departed>(node.membership, leave_cell{"bye"});
  site.pass(0s);
  REQUIRE(*reply);
  CHECK((*reply)->engaged());
  CHECK(site.events.empty());
}

TEST_CASE_METHOD(membership_test, "a node may leave in every phase of joining "
                                  "and join again") {
  for (int delay_ms = 0; delay_ms < 130; delay_ms += 5) {
    CAPTURE(delay_ms);
    virtual_time clock;
    fake_site place{clock, 1};
    place.faults.longest_delay = 20ms;
    auto& x = place.add_node("arm-1", "a-1");
    place.start_coordinator();
    place.start(x);
    place.join(x);
    place.pass(std::chrono::milliseconds{delay_ms});
    auto reply = clock.ask<node_departed>(x.membership, leave_cell{"bye"});
    place.pass(3s);
    REQUIRE(*reply);
    CHECK(place.status(x).state == node_state::independent);
    CHECK_FALSE(x.searching);
    CHECK((!x.link || !x.link->open));
    CHECK(place.base.rows.empty());
    CHECK(place.base.losses.empty());
    place.join(x);
    place.pass(1s);
    CHECK(place.status(x).state == node_state::member);
  }
}

TEST_CASE_METHOD(membership_test, "joining another cell leaves the first one") {
  form_cell();
  site.base.cell = "cell-2";
  caf::anon_send(node.membership, join_cell{"10.0.0.2:11811"});
  site.pass(1s);
  CHECK(site.count("cell_left") == 1);
  CHECK(site.status(node).cell == "cell-2");
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(membership_test, "frames of an earlier session change "
                                  "nothing") {
  form_cell();
  const auto old = node.link;
  cut(*old);
  site.pass(2s);
  REQUIRE(node.link != old);
  const auto frame = write_envelope(envelope_kind::request, 99,
                                    message_json(instance_removal{"t", ""}));
  caf::anon_send(node.membership, frame_received{frame});
  caf::anon_send(node.membership, session_closed{"late"});
  caf::anon_send(old->ends[1], frame_received{frame});
  site.pass(1s);
  CHECK(node.removals.empty());
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(membership_test, "a coordinator that talks nonsense is "
                                  "left") {
  form_cell();
  const auto link = node.link;
  for (auto i = 0; i < 3; ++i)
    caf::anon_send(link->ends[1], frame_received{"{]"});
  site.pass(0s);
  CHECK_FALSE(link->open);
  CHECK(state() == node_state::orphaned);
}

TEST_CASE_METHOD(membership_test, "a session that dies without a word is "
                                  "lost") {
  form_cell();
  time.kill(node.link->ends[1]);
  CHECK(state() == node_state::orphaned);
  site.pass(2s);
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(membership_test, "an idle member and its coordinator wake for "
                                  "the heartbeat only") {
  form_cell();
  site.pass(20s);
  const auto frames = node.link->frames;
  const auto heartbeats = node.link->heartbeats;
  const auto timers = site.timers_fired;
  site.pass(400s);
  CHECK(node.link->frames == frames);
  CHECK(node.link->heartbeats - heartbeats == 200);
  // Two of the member, one of the coordinator, and the wire's own two.
  CHECK(site.timers_fired - timers <= 100 * (2 + 1 + 2));
}

TEST_CASE_METHOD(membership_test, "a membership describes itself") {
  form_cell();
  auto reply = time.ask<actor_state>(node.membership, state_query{});
  site.pass(0s);
  const auto state = json::parse((*reply)->value().json_text);
  CHECK(state["phase"] == "joined");
  CHECK(state["cell"] == "cell-1");
  CHECK(state["epoch"] == 1);
}

} // namespace
