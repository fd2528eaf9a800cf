#include "actors/cell/tables/cell_registry.hpp"

#include "actors/core/limits.hpp"

#include <caf/actor_cast.hpp>
#include <caf/actor_system.hpp>
#include <caf/actor_system_config.hpp>
#include <caf/scoped_actor.hpp>

#include <catch2/catch.hpp>

#include <set>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

registry_time at(std::chrono::milliseconds when) {
  return {std::chrono::steady_clock::time_point{} + when, when.count()};
}

registry_entry node(const std::string& name, const std::string& uuid,
                    int64_t epoch = 1) {
  registry_entry result;
  result.row.identity = {name, uuid, epoch, "10.0.0.2:8420"};
  return result;
}

installed_skill skill(const std::string& hash, const std::string& operation) {
  installed_skill result;
  result.hash = hash;
  result.descriptor.operation = operation;
  return result;
}

} // namespace

TEST_CASE("A name belongs to one UUID while its row is active",
          "[cell_registry]") {
  cell_registry registry;
  registry.activate(node("arm", "u1"), at(0ms));
  CHECK_FALSE(registry.refusal({"arm", "u1", 1, ""}, at(0ms)));
  CHECK_FALSE(registry.refusal({"leg", "u2", 1, ""}, at(0ms)));
  const auto why = registry.refusal({"arm", "u2", 1, ""}, at(24h));
  REQUIRE(why);
  CHECK(why->code == error_code::conflict);
  CHECK(why->message
        == "the name 'arm' belongs to the node with UUID u1 at 10.0.0.2:8420");
}

TEST_CASE("A node's discovery server gets an id that no other has",
          "[cell_registry]") {
  cell_registry registry;
  CHECK(registry.choose_server_id("u1", -1, false, 0, {}) == 1);
  auto arm = node("arm", "u1");
  arm.server_id = 1;
  registry.activate(arm, at(0ms));
  CHECK(registry.choose_server_id("u2", -1, false, 0, {2}) == 3);
  CHECK(registry.choose_server_id("u2", 1, true, 0, {}) == 2);
  CHECK(registry.choose_server_id("u2", 7, true, 0, {}) == 7);
}

TEST_CASE("A node keeps the id of its discovery server, unless another cell "
          "gave it the same",
          "[cell_registry]") {
  cell_registry registry;
  registry.expect({{"arm", "u1", 1, ""}, join_origin::given, 9}, at(0ms));
  CHECK(registry.choose_server_id("u1", -1, false, 0, {}) == 9);
  CHECK(registry.choose_server_id("u1", 12, false, 0, {}) == 9);
  CHECK(registry.choose_server_id("u1", 9, true, 0, {}) == 9);
  CHECK(registry.choose_server_id("u1", 9, false, 0, {}) == 1);
  CHECK(registry.choose_server_id("u2", 1, false, 0, {}) == 2);
}

namespace {

/// A cell with a row less than it may have.
cell_registry almost_full_cell() {
  cell_registry result;
  for (size_t i = 1; i < limits::cell::rows; ++i) {
    auto x = node("n" + std::to_string(i), "u" + std::to_string(i));
    x.server_id = static_cast<int64_t>(i);
    result.activate(x, at(0ms));
  }
  return result;
}

/// The ids of whatever other coordinators there may be.
std::set<int64_t> all_ids() {
  std::set<int64_t> result;
  for (int64_t i = 0; i <= UINT8_MAX; ++i)
    result.insert(i);
  return result;
}

} // namespace

TEST_CASE("A full cell refuses one more node, and says what can be done",
          "[cell_registry]") {
  auto registry = almost_full_cell();
  const node_identity last{"last", "u-last", 1, "10.0.1.1:8420"};
  const node_identity more{"more", "u-more", 1, "10.0.1.2:8420"};
  CHECK_FALSE(registry.refusal(last, at(0ms)));
  SECTION("when the last one is a member") {
    registry.activate(node("last", "u-last"), at(0ms));
  }
  SECTION("when the last one is being written down") {
    registry.propose(node("last", "u-last"));
  }
  const auto why = registry.refusal(more, at(0ms));
  REQUIRE(why);
  CHECK(why->code == error_code::conflict);
  CHECK(why->message
        == "the cell has 250 nodes, those that are away with them, and takes "
           "no more");
  CHECK(why->hint.find("another cell") != std::string::npos);
  CHECK(why->hint.find("roscell release") != std::string::npos);
  // Who is in it may come back.
  CHECK_FALSE(registry.refusal({"n7", "u7", 1, ""}, at(0ms)));
  CHECK_FALSE(registry.refusal(last, at(0ms)));
}

TEST_CASE("Every node that a cell takes gets an id for its discovery server, "
          "whatever coordinators are in sight",
          "[cell_registry]") {
  const auto registry = almost_full_cell();
  CHECK(registry.choose_server_id("more", -1, false, 0, {}) == 250);
  const auto elsewhere = all_ids();
  CHECK(registry.choose_server_id("more", -1, false, 0, elsewhere) == 250);
  // The one that another cell gave it is avoided even then.
  CHECK(registry.choose_server_id("more", 250, false, 0, elsewhere) == 251);
  CHECK(registry.choose_server_id("more", -1, false, 250, elsewhere) == 0);
}

TEST_CASE("A lost node keeps its name for one lease", "[cell_registry]") {
  cell_registry registry;
  auto& row = registry.activate(node("arm", "u1"), at(0ms));
  registry.deactivate(row, row_state::lost, "silent", at(1000ms));
  CHECK(registry.refusal({"arm", "u2", 1, ""}, at(9000ms)));
  CHECK_FALSE(registry.refusal({"arm", "u1", 1, ""}, at(1000ms)));
  CHECK_FALSE(registry.refusal({"arm", "u2", 1, ""}, at(9001ms)));
  registry.activate(node("arm", "u2"), at(9001ms));
  CHECK(registry.rows().size() == 1);
  CHECK(registry.find_uuid("u1") == nullptr);
}

TEST_CASE("Setting the clock frees no name", "[cell_registry]") {
  cell_registry registry;
  auto& row = registry.activate(node("arm", "u1"), at(0ms));
  registry.deactivate(row, row_state::lost, "silent", at(0ms));
  auto later = at(1000ms);
  later.unix_ms += 86'400'000;
  CHECK(registry.refusal({"arm", "u2", 1, ""}, later));
}

TEST_CASE("A node that is expected back keeps its name for some attempts",
          "[cell_registry]") {
  cell_registry registry;
  auto& row = registry.activate(node("arm", "u1"), at(0ms));
  registry.deactivate(row, row_state::expected, "shut down", at(0ms));
  CHECK(registry.refusal({"arm", "u2", 1, ""}, at(45s)));
  CHECK_FALSE(registry.refusal({"arm", "u2", 1, ""}, at(45'001ms)));
}

TEST_CASE("A node known from before gets its name back after a restart",
          "[cell_registry]") {
  cell_registry registry;
  registry.expect({{"arm", "u1", 3, "10.0.0.2:8420"}}, at(1000ms));
  CHECK(registry.refusal({"arm", "u2", 1, ""}, at(1000ms)));
  CHECK_FALSE(registry.refusal({"arm", "u1", 4, ""}, at(1000ms)));
  CHECK_FALSE(registry.refusal({"arm", "u2", 1, ""}, at(46'001ms)));
}

TEST_CASE("Of namesakes that are both expected whoever comes gets the name",
          "[cell_registry]") {
  for (const std::string living : {"u1", "u2"}) {
    cell_registry registry;
    registry.expect({{"arm", "u1", 3, ""}}, at(0ms));
    registry.expect({{"arm", "u2", 3, ""}}, at(0ms));
    CHECK_FALSE(registry.refusal({"arm", living, 4, ""}, at(0ms)));
    const auto records = registry.propose(node("arm", living, 4));
    REQUIRE(records.size() == 2);
    CHECK(records[0].key != living);
    CHECK(records[0].value.empty());
    CHECK(records[1].key == living);
    REQUIRE(registry.accept(living, {}, at(0ms)));
    CHECK(registry.rows().size() == 1);
    CHECK(registry.find_name("arm")->row.identity.uuid == living);
  }
}

TEST_CASE("With the row of a displaced namesake goes its record",
          "[cell_registry]") {
  cell_registry registry;
  auto& old = registry.activate(node("arm", "u1"), at(0ms));
  registry.deactivate(old, row_state::lost, "silent", at(0ms));
  const auto records = registry.propose(node("arm", "u2"));
  // Nothing has happened as long as it is not written down.
  CHECK(registry.find_uuid("u1"));
  CHECK_FALSE(registry.find_uuid("u2"));
  REQUIRE(records.size() == 2);
  CHECK(records[0].table == "members");
  CHECK(records[0].key == "u1");
  CHECK(records[0].value.empty());
  CHECK(json::parse(records[1].value).get<member_record>().identity.uuid
        == "u2");
  REQUIRE(registry.accept("u2", {}, at(0ms)));
  CHECK_FALSE(registry.find_uuid("u1"));
}

TEST_CASE("A name is given to one of two that register at once",
          "[cell_registry]") {
  cell_registry registry;
  registry.propose(node("arm", "u1"));
  CHECK(registry.refusal({"arm", "u2", 1, ""}, at(0ms)));
  CHECK_FALSE(registry.refusal({"arm", "u1", 2, ""}, at(0ms)));
  registry.withdraw("u1", {});
  CHECK_FALSE(registry.refusal({"arm", "u2", 1, ""}, at(0ms)));
  CHECK_FALSE(registry.accept("u1", {}, at(0ms)));
}

TEST_CASE("A UUID in use at one address is refused at another",
          "[cell_registry]") {
  caf::actor_system_config config;
  caf::actor_system system{config};
  caf::scoped_actor session{system};
  auto here = node("arm", "u1", 5);
  here.member =
      caf::actor_cast<member_actor>(caf::actor_cast<caf::actor>(session));
  const node_identity copy{"copy", "u1", 9, "10.0.0.9:8420"};
  cell_registry registry;
  registry.propose(here);
  CHECK(registry.refusal(copy, at(0ms)));
  REQUIRE(registry.accept("u1", here.member, at(0ms)));
  const auto why = registry.refusal(copy, at(24h));
  REQUIRE(why);
  CHECK(why->message
        == "this UUID is in use at 10.0.0.2:8420: its data directory is a "
           "copy");
  CHECK(why->hint.find("--new-identity") != std::string::npos);
  // A restart at its own address, and a move while nobody lives there.
  CHECK_FALSE(registry.refusal({"arm", "u1", 6, "10.0.0.2:8420"}, at(0ms)));
  registry.deactivate(*registry.find_uuid("u1"), row_state::lost, "", at(0ms));
  CHECK_FALSE(registry.refusal(copy, at(0ms)));
}

TEST_CASE("A name that its owner leaves goes to the next row of that name",
          "[cell_registry]") {
  cell_registry registry;
  registry.expect({{"arm", "u1", 3, ""}}, at(0ms));
  registry.reserve({"arm", "u2", 1, ""}, at(5s).steady, at(1s));
  CHECK(registry.find_name("arm")->row.identity.uuid == "u1");
  registry.erase("u1");
  REQUIRE(registry.find_name("arm"));
  CHECK(registry.find_name("arm")->row.identity.uuid == "u2");
  registry.drop_overdue(at(5s).steady);
  CHECK_FALSE(registry.find_name("arm"));
}

TEST_CASE("A registration of an older epoch is refused", "[cell_registry]") {
  cell_registry registry;
  registry.activate(node("arm", "u1", 5), at(0ms));
  CHECK(registry.refusal({"arm", "u1", 4, ""}, at(0ms)));
  CHECK_FALSE(registry.refusal({"arm", "u1", 5, ""}, at(0ms)));
  CHECK_FALSE(registry.refusal({"arm", "u1", 6, ""}, at(0ms)));
}

TEST_CASE("The same UUID back replaces its row", "[cell_registry]") {
  cell_registry registry;
  auto& old = registry.activate(node("arm", "u1", 1), at(0ms));
  registry.deactivate(old, row_state::lost, "silent", at(10ms));
  auto again = node("left-arm", "u1", 2);
  again.row.reason = "left over";
  registry.activate(again, at(20ms));
  const auto rows = registry.rows();
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].identity.name == "left-arm");
  CHECK(rows[0].identity.epoch == 2);
  CHECK(rows[0].state == row_state::active);
  CHECK(rows[0].since_unix_ms == 20);
  CHECK(rows[0].reason.empty());
  CHECK(rows[0].instances.empty());
}

TEST_CASE("Only active rows are counted and have an agent", "[cell_registry]") {
  cell_registry registry;
  registry.activate(node("b", "u2"), at(0ms));
  auto& lost = registry.activate(node("a", "u1"), at(0ms));
  CHECK(registry.active_count() == 2);
  registry.deactivate(lost, row_state::lost, "silent", at(7ms));
  CHECK(registry.active_count() == 1);
  CHECK_FALSE(lost.agent);
  CHECK(lost.row.reason == "silent");
  CHECK(lost.row.since_unix_ms == 7);
  size_t visited = 0;
  registry.for_each_active([&](const auto&) { ++visited; });
  CHECK(visited == 1);
  // In the order of names, whatever their UUIDs.
  CHECK(registry.rows()[0].identity.name == "a");
}

TEST_CASE("Skills of the same content are one row, of active nodes only",
          "[cell_registry]") {
  cell_registry registry;
  auto b = node("b", "u1");
  b.skills = {skill("h1", "echo"), skill("h2", "pose")};
  auto a = node("a", "u2");
  a.skills = {skill("h1", "echo")};
  auto gone = node("gone", "u3");
  gone.skills = {skill("h3", "echo")};
  registry.activate(b, at(0ms));
  registry.activate(a, at(0ms));
  registry.deactivate(registry.activate(gone, at(0ms)), row_state::lost, "",
                      at(0ms));
  const auto all = registry.skills("");
  REQUIRE(all.size() == 2);
  CHECK(all[0].skill.hash == "h1");
  CHECK(all[0].nodes == std::vector<std::string>{"a", "b"});
  CHECK(all[1].nodes == std::vector<std::string>{"b"});
  REQUIRE(registry.skills("pose").size() == 1);
  CHECK(registry.skills("dance").empty());
}

TEST_CASE("Each node tells when it got a build, and what it refused",
          "[cell_registry]") {
  cell_registry registry;
  auto b = node("b", "u1");
  b.skills = {skill("h1", "echo")};
  b.skills[0].added_unix_ms = 2;
  b.refused_skills = {{"/skills/x", "", "no program"}};
  auto a = node("a", "u2");
  a.skills = {skill("h1", "echo")};
  a.skills[0].added_unix_ms = 7;
  registry.activate(b, at(0ms));
  registry.activate(a, at(0ms));
  const auto rows = registry.skills("");
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].nodes == std::vector<std::string>{"a", "b"});
  CHECK(rows[0].added_unix_ms == std::vector<int64_t>{7, 2});
  const auto refused = registry.refused_skills();
  REQUIRE(refused.size() == 1);
  CHECK(refused[0].node == "b");
  CHECK(refused[0].problem.message == "no program");
}

} // namespace roscell::test
