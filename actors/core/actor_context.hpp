#pragma once

#include "actors/core/actor_directory.hpp"
#include "actors/core/alarm.hpp"
#include "actors/core/blocking_threads.hpp"
#include "actors/core/clocks.hpp"
#include "actors/core/metric_table.hpp"
#include "messages/event_kinds.hpp"
#include "messages/inside/introspection.hpp"

#include <caf/actor_system.hpp>
#include <caf/mailbox_element.hpp>
#include <caf/send.hpp>
#include <caf/stateful_actor.hpp>
#include <caf/typed_event_based_actor.hpp>

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace roscell {

/// What every actor of one node shares.
struct actor_context {
  std::shared_ptr<actor_directory> directory;
  event_log_actor events; ///< Invalid in tests that do not care for events.
  /// Milliseconds since this host was booted; a test has its own.
  int64_t (*boot_now_ms)(caf::actor_system&) = roscell::boot_now_ms;

  /// What is counted; null in tests that do not care.
  std::shared_ptr<metric_table> metrics;

  /// Where actors that block work; null in tests that let all run as others.
  std::shared_ptr<blocking_threads> blocking;

  /// Counts something, or measures it once.
  void count(metric which, metric_table::label_values labels,
             double amount = 1) const;
  void observe(metric which, metric_table::label_values labels,
               double value) const;

  /// Records an event; `data` is an object or null.
  void publish_event(const event_kind& what, std::string subject,
                     const json& data = nullptr) const;
};

/// A timeout of an `alarm` as the tick that it is for; all else stays as it is.
/// CAF would drop it: it knows its own timeouts only.
caf::mailbox_element_ptr with_alarm_as_tick(caf::mailbox_element_ptr what);

/// With which an actor ends that has thrown. CAF would print what was thrown,
/// by a thread that is there for nothing else, and say nothing of it to those
/// who watch the actor.
caf::error end_by_exception(const std::exception_ptr& thrown);

/// An actor whose messages and handling times are counted, and which leaves
/// nothing in the clock: neither alarms when it ends nor, while it lives, the
/// timeouts of requests that have been answered, which CAF 0.17.6 keeps until
/// their time is up. It works on `threads`; null: where CAF has it work.
template <class Handle, class State>
class counted_actor final
    : public caf::stateful_actor<State, typename Handle::base> {
public:
  using super = caf::stateful_actor<State, typename Handle::base>;
  using behavior_type = typename Handle::behavior_type;
  using pointer = super*;

  counted_actor(caf::actor_config& cfg,
                std::shared_ptr<actor_counters> counters,
                std::function<behavior_type(pointer)> init,
                std::shared_ptr<blocking_threads> threads)
      : super(cfg), counters_(std::move(counters)), init_(std::move(init)),
        threads_(std::move(threads)), works_there_(threads_ != nullptr) {
    counters_->begin(this->address());
    this->set_exception_handler(
        [](std::exception_ptr& thrown) { return end_by_exception(thrown); });
    if (works_there_)
      threads_->enter();
  }

  void enqueue(caf::mailbox_element_ptr what,
               caf::execution_unit* host) override {
    ++counters_->received;
    super::enqueue(with_alarm_as_tick(std::move(what)),
                   threads_ ? threads_.get() : host);
  }

  void launch(caf::execution_unit* host, bool lazy, bool hide) override {
    super::launch(threads_ ? threads_.get() : host, lazy, hide);
  }

  bool cleanup(caf::error&& reason, caf::execution_unit* host) override {
    const auto result = super::cleanup(std::move(reason), host);
    if (std::exchange(works_there_, false))
      threads_->leave();
    return result;
  }

protected:
  behavior_type make_behavior() override {
    // Dropped after use: handles kept in an actor's members never die.
    auto init = std::exchange(init_, nullptr);
    const working_as scope{this->id()};
    return init(this);
  }

  caf::invoke_message_result consume(caf::mailbox_element& what) override {
    using namespace std::chrono;
    const working_as scope{this->id()};
    const auto begin = steady_clock::now();
    const auto id = what.mid;
    const auto result = super::consume(what);
    if (result != caf::invoke_message_result::skipped) {
      if (id.is_response())
        this->clock().cancel_request_timeout(this, id);
      const auto spent = steady_clock::now() - begin;
      counters_->add(
          static_cast<uint64_t>(duration_cast<microseconds>(spent).count()));
    }
    return result;
  }

private:
  std::shared_ptr<actor_counters> counters_;
  std::function<behavior_type(pointer)> init_;
  const std::shared_ptr<blocking_threads> threads_;
  bool works_there_;
};

/// How all actors are spawned. `function` is the actor's free function
/// `handle::behavior_type f(handle::stateful_pointer<state>, params...)`; its
/// state has a `static constexpr const char* name`.
template <caf::spawn_options Options, class State, class... Sigs,
          class... Params, class... Args>
caf::typed_actor<Sigs...>
spawn_on(std::shared_ptr<blocking_threads> threads, caf::actor_system& system,
         const actor_context& context,
         caf::typed_behavior<Sigs...> (*function)(
             caf::stateful_actor<State, caf::typed_event_based_actor<Sigs...>>*,
             Params...),
         Args&&... args) {
  using actor_type = counted_actor<caf::typed_actor<Sigs...>, State>;
  auto init = [function, captured = std::make_tuple(std::forward<Args>(
                             args)...)](typename actor_type::pointer self) {
    return std::apply([&](const auto&... xs) { return function(self, xs...); },
                      captured);
  };
  return system.spawn<actor_type, Options>(
      context.directory->enter(State::name), std::move(init),
      std::move(threads));
}

/// Spawns an actor that does not block.
template <caf::spawn_options Options = caf::no_spawn_options, class Function,
          class... Args>
auto spawn(caf::actor_system& system, const actor_context& context,
           Function function, Args&&... args) {
  return spawn_on<Options>(nullptr, system, context, function,
                           std::forward<Args>(args)...);
}

/// Spawns an actor that blocks now and then, on a disk or on a library.
template <class Function, class... Args>
auto spawn_blocking(caf::actor_system& system, const actor_context& context,
                    Function function, Args&&... args) {
  return spawn_on<caf::no_spawn_options>(context.blocking, system, context,
                                         function, std::forward<Args>(args)...);
}

/// Shorthand for the clause that every behaviour has.
inline actor_state state_of(const json& object) {
  return {object.dump(-1, ' ', false, json::error_handler_t::replace)};
}

} // namespace roscell
