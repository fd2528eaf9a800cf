#include "actors/core/watching.hpp"

#include "test/fixture.hpp"

namespace roscell::test {

namespace {

using watcher_actor = caf::typed_actor<caf::reacts_to<caf::tick_atom>>;
using watch = void (*)(watcher_actor::pointer, const caf::actor&);

void until_own_end(watcher_actor::pointer self, const caf::actor& whom) {
  watch_until_own_end(self, whom);
}

void until_its_end(watcher_actor::pointer self, const caf::actor& whom) {
  watch_until_its_end(self, whom);
}

/// Ends at its first tick, or when whom it watches ends.
watcher_actor::behavior_type watcher(watcher_actor::pointer self, watch begin,
                                     const caf::actor& whom) {
  begin(self, whom);
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  return {[self](caf::tick_atom) { self->quit(); }};
}

caf::behavior ends_at_a_tick(caf::event_based_actor* self) {
  return {[self](caf::tick_atom) { self->quit(); }};
}

struct watched : virtual_time {
  caf::actor whom = system.spawn(ends_at_a_tick);

  /// A watcher's address, when the tick has come and it is not held any more.
  caf::actor_addr end(const caf::actor& who, watch how) {
    auto begun = system.spawn(watcher, how, whom);
    settle();
    caf::anon_send(who ? who : caf::actor_cast<caf::actor>(begun),
                   caf::tick_atom_v);
    settle();
    return begun.address();
  }
};

/// Who keeps the memory of an actor that has ended, besides `x`.
size_t keepers_of(const caf::actor_addr& x) {
  return caf::actor_cast<caf::actor_control_block*>(x)->weak_refs - 1;
}

bool has_ended(const caf::actor_addr& x) {
  return caf::actor_cast<caf::strong_actor_ptr>(x) == nullptr;
}

} // namespace

TEST_CASE_METHOD(watched,
                 "a watch until the own end leaves nothing with whom it was on",
                 "[watching]") {
  const auto ended = end(nullptr, until_own_end);
  REQUIRE(has_ended(ended));
  CHECK(keepers_of(ended) == 0);
  // What the watch is for.
  CHECK(keepers_of(end(nullptr, until_its_end)) == 1);
}

TEST_CASE_METHOD(watched, "who watches is told of the end", "[watching]") {
  const auto how = GENERATE(until_own_end, until_its_end);
  const auto reported = end(whom, how);
  CHECK(has_ended(reported));
  whom = nullptr;
  CHECK(keepers_of(reported) == 0);
}

} // namespace roscell::test
