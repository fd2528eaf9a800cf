#include "embedding/task_calls.hpp"

#include "actors/core/alarm.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/session/limits.hpp"
#include "messages/failure.hpp"
#include "schemas/document.hpp"

#include <caf/scoped_actor.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <mutex>
#include <utility>
#include <variant>

namespace roscell::embedding {

namespace {

[[noreturn]] void throw_failure(const failure& why) {
  throw node_error{std::string{to_string(why.code)},
                   why.where.empty() ? why.message
                                     : why.where + ": " + why.message,
                   why.hint};
}

} // namespace

json ask_node(const task_door& door, const json& request,
              std::chrono::milliseconds limit) {
  caf::scoped_actor self{*door.system};
  json answer;
  caf::error gone;
  self->request(door.router, limit,
                route_request{request.dump(-1, ' ', false,
                                           json::error_handler_t::replace),
                              "", "the program around the node"})
      .receive(
          [&](const request_routed& x) {
            answer = json::parse(x.text, nullptr, false);
          },
          [&](caf::error& why) { gone = std::move(why); });
  if (gone)
    throw_failure(to_failure(gone));
  if (answer.value("type", "") == "error")
    throw_failure(failure_from(answer));
  return answer;
}

std::string run_task(const task_door& door, const std::string& request,
                     std::chrono::milliseconds limit) {
  auto parsed = parse_document(request, format_of("", request));
  if (const auto* why = std::get_if<failure>(&parsed))
    throw_failure(*why);
  auto& document = std::get<json>(parsed);
  if (document.is_object())
    document["type"] = task_request::type;
  const auto answer = ask_node(door, document, limit);
  return answer.value("task", "");
}

task_status status_of(const std::vector<task_row>& rows,
                      const std::string& task) {
  task_status result;
  result.task = task;
  result.state = "gone";
  for (const auto& row : rows) {
    if (row.task != task)
      continue;
    result.state = to_string(row.state);
    for (const auto& x : row.instances)
      result.steps.push_back(
          {x.spec.step, x.spec.instance, x.node, to_string(x.state), x.reason});
  }
  return result;
}

task_status status_of_task(const task_door& door, const std::string& task,
                           std::chrono::milliseconds limit) {
  try {
    const auto answer = ask_node(door, message_json(task_query{task}), limit);
    return status_of(answer.get<task_description>().tasks, task);
  } catch (const node_error& why) {
    if (why.code() != to_string(error_code::unknown_task))
      throw;
    return {task, "gone", {}};
  }
}

} // namespace roscell::embedding

namespace roscell {

/// What the watcher and whoever holds the watch share.
class task_watch::impl {
public:
  explicit impl(std::function<void(const task_status&)> on_change)
      : on_change_(std::move(on_change)) {}

  /// Tells of a status unless it is the last one.
  void notify(const task_status& now) {
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

/// After which a watch asks again when the cell could not be asked: the first
/// pause, which doubles up to the longest.
constexpr std::chrono::seconds first_pause{1};
constexpr std::chrono::seconds longest_pause{30};

using task_watcher_actor =
    introspected_actor::extend< // INTERNAL: alarm number N is due.
        caf::reacts_to<caf::tick_atom, uint64_t>>;

struct task_watcher_state {
  static constexpr const char* name = "task-watcher";

  task_door door;
  task_change_query query;
  std::weak_ptr<task_watch::impl> watch;
  std::chrono::seconds pause = first_pause;
  alarm timer;
};

using watcher_pointer =
    task_watcher_actor::stateful_pointer<task_watcher_state>;

void ask_for_change(watcher_pointer self);

void on_answer(watcher_pointer self, const json& answer) {
  auto& st = self->state;
  const auto watch = st.watch.lock();
  if (!watch)
    return self->quit();
  if (answer.value("type", "") != task_change::type) {
    st.timer.set(self, self->clock().now() + st.pause);
    st.pause = std::min(2 * st.pause, longest_pause);
    return;
  }
  auto change = answer.get<task_change>();
  st.pause = first_pause;
  st.query.known = std::move(change.mark);
  watch->notify(status_of(change.tasks, st.query.task));
  ask_for_change(self);
}

/// Whoever answers, here or at the coordinator, does so when there is something
/// new, or after a while to show that he is still there.
void ask_for_change(watcher_pointer self) {
  auto& st = self->state;
  self->request(st.door.router, limits::request::router,
                route_request{message_json(st.query).dump(), "", ""})
      .then(
          [self](const request_routed& x) {
            on_answer(self, json::parse(x.text, nullptr, false));
          },
          [self](const caf::error&) { self->quit(); });
}

/// Has a thread of its own: the program's call may take its time.
task_watcher_actor::behavior_type
task_watcher(watcher_pointer self, const task_door& door,
             const std::string& task,
             const std::weak_ptr<task_watch::impl>& watch) {
  auto& st = self->state;
  st.door = door;
  st.query.task = task;
  st.query.wait_ms = limits::task::change_wait.count();
  st.watch = watch;
  ask_for_change(self);
  return {
      [self](const state_query&) {
        return state_of({{"task", self->state.query.task}});
      },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          ask_for_change(self);
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
  return result;
}

} // namespace roscell::embedding
