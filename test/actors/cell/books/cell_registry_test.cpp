#include "actors/cell/books/cell_registry.hpp"

#include <caf/actor_cast.hpp>

#include <catch2/catch.hpp>

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

instance_row instance(const std::string& id, const std::string& on,
                      instance_state state = instance_state::running) {
  instance_row result;
  result.spec.instance = id;
  result.node = on;
  result.state = state;
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
  CHECK(why->find("'arm'") != std::string::npos);
  CHECK(why->find("u1") != std::string::npos);
  CHECK(why->find("10.0.0.2:8420") != std::string::npos);
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

TEST_CASE("A node that is expected back keeps its name", "[cell_registry]") {
  cell_registry registry;
  auto& row = registry.activate(node("arm", "u1"), at(0ms));
  registry.deactivate(row, row_state::expected, "shut down", at(0ms));
  CHECK(registry.refusal({"arm", "u2", 1, ""}, at(24h)));
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
  old.row.instances = {instance("i1", "arm")};
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

TEST_CASE("Instances are updated on their node and found anywhere",
          "[cell_registry]") {
  cell_registry registry;
  registry.activate(node("a", "u1"), at(0ms));
  registry.activate(node("b", "u2"), at(0ms));
  registry.update_instance(instance("i1", "b", instance_state::starting));
  registry.update_instance(instance("i1", "b"));
  registry.update_instance(instance("i2", "nowhere"));
  REQUIRE(registry.find_instance("i1"));
  CHECK(registry.find_instance("i1")->state == instance_state::running);
  CHECK(registry.find_name("b")->row.instances.size() == 1);
  CHECK(registry.find_instance("i2") == nullptr);
  registry.erase_instance("i1");
  CHECK(registry.find_instance("i1") == nullptr);
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
