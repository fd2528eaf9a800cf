#include "test/fixture.hpp"

#include <map>
#include <string>

namespace roscell::test {

namespace {

using spawning_actor =
    caf::typed_actor<caf::replies_to<state_query>::with<actor_state>>;

template <int Level>
struct level_state {
  static constexpr const char* name = Level == 0   ? "grandchild"
                                      : Level == 1 ? "child"
                                                   : "parent";
  caf::actor below;
};

/// Spawns the level below it when it is asked, and asks that one.
template <int Level>
spawning_actor::behavior_type
level(spawning_actor::stateful_pointer<level_state<Level>> self,
      const actor_context& context) {
  return {[self, context](const state_query&) -> actor_state {
    if constexpr (Level > 0) {
      self->state.below = caf::actor_cast<caf::actor>(
          spawn(self->system(), context, level<Level - 1>, context));
      caf::anon_send(self->state.below, state_query{});
    }
    return {"{}"};
  }};
}

struct early_state {
  static constexpr const char* name = "early";
  caf::actor below;
};

/// Spawns one before its first message.
spawning_actor::behavior_type
early(spawning_actor::stateful_pointer<early_state> self,
      const actor_context& context) {
  self->state.below = caf::actor_cast<caf::actor>(
      spawn(self->system(), context, level<1>, context));
  return {[](const state_query&) -> actor_state { return {"{}"}; }};
}

std::map<std::string, actor_row> by_name(const actor_directory& actors) {
  std::map<std::string, actor_row> result;
  for (const auto& x : actors.rows())
    result[x.name] = x;
  return result;
}

} // namespace

TEST_CASE("an actor is the child of the one whose message spawned it",
          "[directory]") {
  virtual_time t;
  const auto top = spawn(t.system, t.context, level<2>, t.context);
  caf::anon_send(top, state_query{});
  t.settle();
  auto rows = by_name(*t.context.directory);
  CHECK(rows["parent"].parent == 0);
  CHECK(rows["child"].parent == rows["parent"].id);
  CHECK(rows["grandchild"].parent == rows["child"].id);
  CHECK(rows["parent"].id != 0);
}

TEST_CASE("an actor may have children before its first message",
          "[directory]") {
  virtual_time t;
  const auto top = spawn(t.system, t.context, early, t.context);
  t.settle();
  auto rows = by_name(*t.context.directory);
  CHECK(rows["early"].id != 0);
  CHECK(rows["child"].parent == rows["early"].id);
}

TEST_CASE("what is spawned by no actor has no parent", "[directory]") {
  virtual_time t;
  const auto before = spawn(t.system, t.context, level<2>, t.context);
  caf::anon_send(before, state_query{});
  t.settle();
  // This thread has done the work of three actors, and does none's now.
  const auto after = spawn(t.system, t.context, level<0>, t.context);
  t.settle();
  CHECK(t.context.directory->rows().back().parent == 0);
}

} // namespace roscell::test
