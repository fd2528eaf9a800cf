#pragma once

#include "actors/core/actor_context.hpp"
#include "messages/messages.hpp"

#include <caf/actor_system.hpp>
#include <caf/actor_system_config.hpp>
#include <caf/event_based_actor.hpp>
#include <caf/scheduler/test_coordinator.hpp>
#include <caf/scoped_actor.hpp>
#include <caf/send.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace roscell::test {

struct virtual_time_config : caf::actor_system_config {
  virtual_time_config() {
    set("scheduler.policy", caf::atom("testing"));
  }
};

/// An actor system without threads whose clock moves only when told to.
struct virtual_time {
  virtual_time_config config;
  caf::actor_system system{config};
  caf::scheduler::test_coordinator& scheduler =
      dynamic_cast<caf::scheduler::test_coordinator&>(system.scheduler());
  actor_context context{std::make_shared<actor_directory>(), {}, boot_now_ms};

  /// This host was booted a million seconds before the test began.
  static constexpr int64_t boot_ms_at_start = 1'000'000'000;

  static int64_t boot_now_ms(caf::actor_system& system) {
    using namespace std::chrono;
    return boot_ms_at_start
           + duration_cast<milliseconds>(
                 system.clock().now().time_since_epoch())
                 .count();
  }

  /// Handles every message that is there or arises from these.
  void settle() {
    scheduler.run();
  }

  /// Lets time pass, in steps that keep periodic timers in order.
  void advance(std::chrono::milliseconds span) {
    using namespace std::chrono_literals;
    settle();
    for (auto left = span; left > 0ms;) {
      const auto step = std::min<std::chrono::milliseconds>(left, 50ms);
      scheduler.clock().advance_time(step);
      settle();
      left -= step;
    }
  }

  /// Lets time pass exactly, from one timer to the next. Gives how many rang.
  size_t pass(std::chrono::milliseconds span) {
    auto& clock = scheduler.clock();
    const auto end = clock.now() + span;
    size_t rung = 0;
    for (;;) {
      settle();
      if (!clock.has_pending_timeout() || clock.schedule().begin()->first > end)
        break;
      const auto next = clock.schedule().begin()->first;
      rung += clock.advance_time(
          std::max(next - clock.now(), decltype(next - next){0}));
    }
    clock.advance_time(end - clock.now());
    settle();
    return rung;
  }

  /// Sends a request; its outcome is there once messages have been handled.
  template <class Reply, class Handle, class... Ts>
  auto ask(const Handle& whom, Ts... xs) {
    auto result = std::make_shared<std::optional<caf::expected<Reply>>>();
    system.spawn([=](caf::event_based_actor* self) {
      self->request(caf::actor_cast<caf::actor>(whom), caf::infinite, xs...)
          .then([result](Reply& reply) { *result = std::move(reply); },
                [result](caf::error& why) { *result = std::move(why); });
    });
    return result;
  }

  /// Ends an actor of the test at once.
  template <class Handle>
  void kill(const Handle& whom) {
    caf::anon_send_exit(whom, caf::exit_reason::kill);
    settle();
  }
};

/// Keeps what it is sent; for handles that only react.
template <class... Ts>
struct recorder {
  std::vector<std::variant<Ts...>> seen;
};

} // namespace roscell::test
