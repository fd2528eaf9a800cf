#include "actors/core/alarm.hpp"

#include "test/fixture.hpp"

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

/// Sets its alarm as it is told, and counts how often it rings.
struct sleeper_state {
  static constexpr const char* name = "sleeper";

  alarm timer;
  int ticks = 0;
  int rung = 0;
};

/// In so many milliseconds; true: not before.
using sleeper_actor =
    caf::typed_actor<caf::reacts_to<int64_t, bool>,
                     caf::replies_to<caf::get_atom>::with<int, int>,
                     caf::reacts_to<caf::tick_atom, uint64_t>>;

sleeper_actor::behavior_type
sleeper(sleeper_actor::stateful_pointer<sleeper_state> self) {
  return {
      [self](int64_t span_ms, bool anew) {
        const auto when =
            self->clock().now() + std::chrono::milliseconds{span_ms};
        if (anew)
          self->state.timer.set_anew(self, when);
        else
          self->state.timer.set(self, when);
      },
      [self](caf::get_atom) {
        return std::make_tuple(self->state.ticks, self->state.rung);
      },
      [self](caf::tick_atom, uint64_t number) {
        ++self->state.ticks;
        self->state.rung += self->state.timer.rings(number) ? 1 : 0;
      },
  };
}

struct night : virtual_time {
  sleeper_actor who = spawn(system, context, sleeper);

  ~night() {
    if (who)
      kill(who);
  }

  void set(std::chrono::milliseconds span, bool anew = false) {
    caf::anon_send(who, int64_t{span.count()}, anew);
  }

  /// How many ticks came, and how many of them rang.
  std::pair<int, int> heard() {
    std::pair<int, int> result;
    system.spawn([&](caf::event_based_actor* self) {
      self->request(who, caf::infinite, caf::get_atom_v)
          .then([&](int ticks, int rung) {
            result = {ticks, rung};
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

TEST_CASE_METHOD(night, "an alarm ends with its actor", "[alarm]") {
  set(1h);
  settle();
  CHECK(waiting() == 1);
  const auto address = who.address();
  kill(who);
  who = nullptr;
  CHECK(waiting() == 0);
  // Nothing keeps its memory.
  CHECK(caf::actor_cast<caf::actor_control_block*>(address)->weak_refs == 1);
}

TEST_CASE_METHOD(night, "an alarm that is set often is one in the clock",
                 "[alarm]") {
  for (int i = 0; i < 100; ++i)
    set(1h - i * 1s);
  settle();
  CHECK(waiting() == 1);
}

TEST_CASE_METHOD(night, "an alarm rings at the earliest time that was set",
                 "[alarm]") {
  set(20s);
  set(5s);
  set(10s);
  pass(4999ms);
  CHECK(heard() == std::pair{0, 0});
  pass(1ms);
  CHECK(heard() == std::pair{1, 1});
  pass(1min);
  CHECK(heard() == std::pair{1, 1});
}

TEST_CASE_METHOD(night, "an alarm that is set anew rings then", "[alarm]") {
  set(5s);
  set(20s, true);
  pass(19'999ms);
  CHECK(heard() == std::pair{0, 0});
  pass(1ms);
  CHECK(heard() == std::pair{1, 1});
}

TEST_CASE_METHOD(night, "a tick under way does not ring an alarm set anew",
                 "[alarm]") {
  set(1s);
  settle();
  set(20s, true);
  scheduler.clock().advance_time(1s);
  CHECK(heard() == std::pair{1, 0});
  pass(20s);
  CHECK(heard() == std::pair{2, 1});
}

TEST_CASE_METHOD(night, "an alarm for a time that has passed rings at once",
                 "[alarm]") {
  set(-1s);
  pass(0ms);
  CHECK(heard() == std::pair{1, 1});
}

} // namespace roscell::test
