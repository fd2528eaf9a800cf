#include "actors/house/alarm.hpp"
#include "actors/house/limits.hpp"
#include "actors/house/watching.hpp"
#include "embedding/task_calls.hpp"

#include <caf/send.hpp>

#include <mutex>
#include <utility>

namespace roscell {

/// What the watcher and whoever holds the watch share.
class task_watch::impl {
public:
  explicit impl(std::function<void(const task_status&)> on_change)
      : on_change_(std::move(on_change)) {}

  /// Tells of a status unless it is the last one.
  void tell(const task_status& now) {
    const std::lock_guard<std::recursive_mutex> lock{mutex_};
    if (!on_change_ || (last_.state == now.state && last_ == now))
      return;
    last_ = now;
    try {
      // A copy, for it may end the watch that holds it.
      const auto call = on_change_;
      call(now);
    } catch (...) {
      // It is the program's own.
    }
  }

  void watch_by(const caf::actor& watcher) {
    watcher_ = watcher;
  }

  void end() {
    {
      const std::lock_guard<std::recursive_mutex> lock{mutex_};
      on_change_ = nullptr;
    }
    caf::anon_send_exit(watcher_, caf::exit_reason::user_shutdown);
  }

private:
  std::recursive_mutex mutex_; // Guards what follows, but for the watcher.
  std::function<void(const task_status&)> on_change_;
  task_status last_;
  caf::actor watcher_;
};

task_watch::task_watch(std::shared_ptr<impl> parts) : impl_(std::move(parts)) {}

task_watch::~task_watch() {
  if (impl_)
    impl_->end();
}

task_watch::task_watch(task_watch&&) noexcept = default;

task_watch& task_watch::operator=(task_watch&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

} // namespace roscell

namespace roscell::embedding {

namespace {

/// A member is told of its own instances only; what becomes of the others it
/// asks its coordinator so often.
constexpr std::chrono::seconds member_pause{5};

/// More than any event has: only new ones are wanted.
constexpr uint64_t from_now_on = 9007199254740991;

using task_watcher_actor =
    introspected_actor::extend<caf::reacts_to<event>,
                               // INTERNAL: alarm number N is due.
                               caf::reacts_to<caf::tick_atom, uint64_t>>;

struct task_watcher_state {
  static constexpr const char* name = "task-watcher";

  task_door door;
  std::string task;
  std::weak_ptr<task_watch::impl> watch;
  bool asking = false;
  bool again = false; ///< Something has happened since it was asked.
  alarm timer;
};

using watcher_pointer =
    task_watcher_actor::stateful_pointer<task_watcher_state>;

void ask_for_status(watcher_pointer self);

void on_answer(watcher_pointer self, const json& answer) {
  auto& st = self->state;
  st.asking = false;
  const auto watch = st.watch.lock();
  if (!watch)
    return self->quit();
  if (answer.value("type", "") == task_description::type)
    watch->tell(status_in(answer, st.task));
  else if (failure_from(answer).code == error_code::unknown_task)
    watch->tell(status_in(message_json(task_description{}), st.task));
  if (std::exchange(st.again, false))
    ask_for_status(self);
}

/// While it is asked, whatever happens is asked for once more.
void ask_for_status(watcher_pointer self) {
  auto& st = self->state;
  st.again = st.asking;
  if (std::exchange(st.asking, true))
    return;
  self->request(st.door.router, limits::request::router,
                route_request{message_json(task_query{st.task}).dump(), "", ""})
      .then(
          [self](const request_routed& x) {
            on_answer(self, json::parse(x.text, nullptr, false));
          },
          [self](const caf::error&) { self->quit(); });
}

bool is_about(const event& e, const std::string& task) {
  if (e.subject == task)
    return true;
  const auto data = json::parse(e.data, nullptr, false);
  return data.is_object() && data.value("task", json{}) == task;
}

/// Asks for what nobody tells.
void ask_now_and_then(watcher_pointer self) {
  ask_for_status(self);
  if (!self->state.door.is_coordinator)
    self->state.timer.set(self, self->clock().now() + member_pause);
}

/// Has a thread of its own: the program's call may take its time.
task_watcher_actor::behavior_type
task_watcher(watcher_pointer self, const task_door& door,
             const std::string& task,
             const std::weak_ptr<task_watch::impl>& watch) {
  auto& st = self->state;
  st.door = door;
  st.task = task;
  st.watch = watch;
  watch_until_own_end(self, door.events);
  self->set_down_handler([self](const caf::down_msg&) { self->quit(); });
  ask_now_and_then(self);
  return {
      [self](const state_query&) {
        return state_of({{"task", self->state.task}});
      },
      [self](const event& e) {
        if (is_about(e, self->state.task))
          ask_for_status(self);
      },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          ask_now_and_then(self);
      },
  };
}

} // namespace

std::shared_ptr<task_watch::impl>
watch_task(const task_door& door, const std::string& task,
           std::function<void(const task_status&)> on_change) {
  auto result = std::make_shared<task_watch::impl>(std::move(on_change));
  const auto watcher =
      spawn<caf::detached>(*door.system, door.context, task_watcher, door, task,
                           std::weak_ptr<task_watch::impl>{result});
  result->watch_by(caf::actor_cast<caf::actor>(watcher));
  caf::anon_send(door.events, subscribe_events{watcher, from_now_on});
  return result;
}

} // namespace roscell::embedding
