#include "actors/core/actor_context.hpp"

#include "test/fixture.hpp"

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

struct asker_state {
  static constexpr const char* name = "asker";

  int answers = 0;
  int errors = 0;
};

/// Asks whom it is told of, and waits 15 minutes.
using asker_actor =
    caf::typed_actor<caf::reacts_to<caf::put_atom, caf::actor>,
                     caf::replies_to<caf::get_atom>::with<int, int>>;

asker_actor::behavior_type
asker(asker_actor::stateful_pointer<asker_state> self) {
  return {
      [self](caf::put_atom, const caf::actor& whom) {
        self->request(whom, 15min, caf::get_atom_v)
            .then([self](int) { ++self->state.answers; },
                  [self](const caf::error&) { ++self->state.errors; });
      },
      [self](caf::get_atom) {
        return std::make_tuple(self->state.answers, self->state.errors);
      },
  };
}

struct conversation : virtual_time {
  asker_actor who = spawn(system, context, asker);
  caf::actor quick = system.spawn(
      [] { return caf::behavior{[](caf::get_atom) { return 1; }}; });
  caf::actor gruff = system.spawn([] {
    return caf::behavior{[](caf::get_atom) -> caf::result<int> {
      return caf::make_error(caf::sec::runtime_error);
    }};
  });
  std::vector<caf::response_promise> unanswered;
  caf::actor silent = system.spawn([this](caf::event_based_actor* self) {
    return caf::behavior{[this, self](caf::get_atom) {
      unanswered.push_back(self->make_response_promise());
    }};
  });

  ~conversation() {
    unanswered.clear();
    for (const auto& x : {quick, gruff, silent})
      kill(x);
    kill(who);
  }

  void ask_about(const caf::actor& whom) {
    caf::anon_send(who, caf::put_atom_v, whom);
    settle();
  }

  /// How many were answered, and how many with an error.
  std::pair<int, int> heard() {
    std::pair<int, int> result;
    system.spawn([&](caf::event_based_actor* self) {
      self->request(who, caf::infinite, caf::get_atom_v)
          .then([&](int answers, int errors) {
            result = {answers, errors};
          });
    });
    settle();
    return result;
  }

  size_t waiting() {
    return scheduler.clock().schedule().size();
  }
};

} // namespace

TEST_CASE_METHOD(conversation,
                 "an answered request leaves nothing in the clock",
                 "[actor_context]") {
  for (int i = 0; i < 10; ++i)
    ask_about(quick);
  ask_about(gruff);
  CHECK(heard() == std::pair{10, 1});
  CHECK(waiting() == 0);
  CHECK(scheduler.clock().actor_lookup().empty());
}

TEST_CASE_METHOD(conversation,
                 "a request that is not answered ends when its time is up",
                 "[actor_context]") {
  ask_about(silent);
  ask_about(quick);
  CHECK(waiting() == 1);
  pass(15min);
  CHECK(heard() == std::pair{1, 1});
  CHECK(waiting() == 0);
}

TEST_CASE_METHOD(conversation, "a request ends with who has asked",
                 "[actor_context]") {
  ask_about(silent);
  kill(who);
  CHECK(waiting() == 0);
}

} // namespace roscell::test
