#pragma once

#include "actors/house/actor_directory.hpp"
#include "actors/house/boot_clock.hpp"
#include "actors/house/metric_book.hpp"
#include "messages/inside/introspection.hpp"

#include <caf/actor_system.hpp>
#include <caf/mailbox_element.hpp>
#include <caf/send.hpp>
#include <caf/stateful_actor.hpp>
#include <caf/typed_event_based_actor.hpp>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace roscell {

/// What every actor of one node shares.
struct house {
  std::shared_ptr<actor_directory> directory;
  event_log_actor events; ///< Invalid in tests that do not care for facts.
  /// Milliseconds since this host was booted; a test has its own.
  int64_t (*boot_now_ms)(caf::actor_system&) = roscell::boot_now_ms;

  /// What is counted; null in tests that do not care.
  std::shared_ptr<metric_book> metrics;

  /// Counts something, or measures it once.
  void count(metric which, metric_book::label_values labels,
             double amount = 1) const;
  void observe(metric which, metric_book::label_values labels,
               double value) const;

  /// Records a fact; `data` is an object or null.
  void tell(std::string what, std::string subject,
            const json& data = nullptr) const;
};

/// An actor whose messages and handling times are counted.
template <class Handle, class State>
class counted_actor final
    : public caf::stateful_actor<State, typename Handle::base> {
public:
  using super = caf::stateful_actor<State, typename Handle::base>;
  using behavior_type = typename Handle::behavior_type;
  using pointer = super*;

  counted_actor(caf::actor_config& cfg,
                std::shared_ptr<actor_counters> counters,
                std::function<behavior_type(pointer)> init)
      : super(cfg), counters_(std::move(counters)), init_(std::move(init)) {
    counters_->begin(this->address());
  }

  void enqueue(caf::mailbox_element_ptr what,
               caf::execution_unit* host) override {
    ++counters_->received;
    super::enqueue(std::move(what), host);
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
    const auto result = super::consume(what);
    if (result != caf::invoke_message_result::skipped) {
      const auto spent = steady_clock::now() - begin;
      counters_->add(
          static_cast<uint64_t>(duration_cast<microseconds>(spent).count()));
    }
    return result;
  }

private:
  std::shared_ptr<actor_counters> counters_;
  std::function<behavior_type(pointer)> init_;
};

/// The one function that spawns actors. `function` is the actor's free function
/// `handle::behavior_type f(handle::stateful_pointer<state>, params...)`; its
/// state has a `static constexpr const char* name`.
template <caf::spawn_options Options = caf::no_spawn_options, class State,
          class... Sigs, class... Params, class... Args>
caf::typed_actor<Sigs...>
spawn(caf::actor_system& system, const house& context,
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
      context.directory->enter(State::name), std::move(init));
}

/// Shorthand for the clause that every behaviour has.
inline actor_state state_of(const json& object) {
  return {object.dump(-1, ' ', false, json::error_handler_t::replace)};
}

} // namespace roscell
