#pragma once

#include "actors/edge/io/io_thread.hpp"
#include "actors/instances/process/process_runtime.hpp"
#include "messages/failure.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"
#include "test/places.hpp"

#include <sys/types.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// The process runtime with real processes.
namespace roscell::test {

/// Only a failing test ever waits so long.
constexpr std::chrono::seconds patience{30};

/// What the runtime tells, for the thread of the test.
class event_inbox {
public:
  void put(std::string event) {
    const std::lock_guard guard{mutex_};
    events_.push_back(std::move(event));
    changed_.notify_all();
  }

  std::string take() {
    std::unique_lock lock{mutex_};
    if (!changed_.wait_for(lock, patience, [this] { return !events_.empty(); }))
      throw std::runtime_error{"the test waited in vain"};
    auto result = std::move(events_.front());
    events_.pop_front();
    return result;
  }

  /// Skips everything before `event`.
  void await(const std::string& event) {
    auto last = take();
    while (last != event)
      last = take();
  }

private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> events_;
};

/// Ends an actor and waits until it is gone, so that nothing that it points to
/// is missed.
template <class Handle>
void end_and_await(caf::scoped_actor& self, const Handle& whom) {
  self->monitor(whom);
  caf::anon_send_exit(whom, caf::exit_reason::kill);
  self->receive([](const caf::down_msg&) {});
}

/// An event log that a test reads.
inline event_log_actor keep_events(caf::actor_system& system,
                                   event_inbox& events) {
  const auto result = system.spawn([&events]() -> caf::behavior {
    return {[&events](const record_event& x) {
      events.put(x.what + ' ' + x.subject);
    }};
  });
  return caf::actor_cast<event_log_actor>(result);
}

/// What stands in the file of a fence, in milliseconds; 0: nothing.
inline int64_t fence_in(const std::filesystem::path& path) {
  int64_t result = 0;
  std::ifstream file{path, std::ios::binary};
  file.read(reinterpret_cast<char*>(&result), sizeof(result));
  return file ? result : 0;
}

struct real_time_config : caf::actor_system_config {
  real_time_config() {
    set("scheduler.policy", caf::atom("sharing"));
    set("scheduler.max-threads", size_t{1});
  }
};

/// What an exit is told of as: its code, and its cause unless it is usual.
inline std::string text_of_end(const container_exited& x) {
  return std::to_string(x.exit_code)
         + (x.cause == end_cause::usual
                ? ""
                : ", " + std::string{to_string(x.cause)});
}

/// A runtime in real time, and who asks it.
template <class Runtime>
struct runtime_bench {
  template <class Reply, class Request>
  caf::expected<Reply> ask(const Request& request) {
    caf::expected<Reply> result{caf::sec::none};
    self->request(runtime, patience, request)
        .receive([&](Reply& x) { result = std::move(x); },
                 [&](caf::error& why) { result = std::move(why); });
    return result;
  }

  template <class Reply, class Request>
  Reply get(const Request& request) {
    auto result = ask<Reply>(request);
    if (!result)
      FAIL(to_failure(result.error()).message);
    return std::move(*result);
  }

  template <class Reply, class Request>
  failure refusal(const Request& request) {
    const auto result = ask<Reply>(request);
    REQUIRE_FALSE(result);
    return to_failure(result.error());
  }

  temp_folder folder;
  real_time_config system_config;
  caf::actor_system system{system_config};
  caf::scoped_actor self{system};
  actor_context context{std::make_shared<actor_directory>(), {}};
  io_thread io;
  event_inbox reported;
  event_inbox reported_events;
  event_log_actor events;
  container_listener_actor listener;
  Runtime runtime;
};

/// Real processes under a real shim. What is still running at the end is
/// killed.
struct process_bench : runtime_bench<process_runtime_actor> {
  process_bench() {
    config.instances_dir = folder.path() / "data" / "instances";
    config.shim =
        std::filesystem::path{test::build_dir()} / "bin/roscell-instance-shim";
    config.io = io.core();
    config.context = context;
    config.context.events = events = keep_events(system, reported_events);
    config.environment = basic_environment();
    using handle = container_listener_actor;
    listener = system.spawn([this](handle::pointer) -> handle::behavior_type {
      return {
          [this](const container_exited& x) {
            reported.put("exit " + text_of_end(x));
          },
          [this](const instance_notified& x) {
            if (x.ready)
              reported.put("ready");
            if (x.heard)
              reported.put("heard");
          },
          [](const runtime_problem_changed&) {
            // Processes have no engine.
          },
      };
    });
    restart();
  }

  ~process_bench() {
    for (const auto& instance : instances)
      ask<container_removed>(remove_container{instance, {}});
    end_and_await(self, runtime);
    end_and_await(self, listener);
    end_and_await(self, events);
  }

  /// The node ends; its programs go on.
  void leave() {
    end_and_await(self, runtime);
    runtime = nullptr;
  }

  /// A fresh runtime that knows nothing, as after a restart of the node.
  void restart() {
    if (runtime)
      leave();
    runtime = roscell::spawn<caf::detached>(system, context, process_runtime,
                                            config, listener);
  }

  /// Runs a shell script as the skill's program.
  std::string start(const std::string& script,
                    const std::string& instance = "i",
                    int64_t fence_boot_ms = 0) {
    folder.write("skill/bin/run", "#!/bin/sh\n" + script + "\n", true);
    instances.push_back(instance);
    start_container order;
    order.instance = instance;
    order.image = folder.path() / "skill";
    order.command = {"bin/run", "an argument"};
    order.environment = {{"GIVEN", "yes"}};
    order.fence_boot_ms = fence_boot_ms;
    return get<container_started>(order).container;
  }

  log_excerpt log(int64_t offset, int64_t wait_ms = 0,
                  const std::string& instance = "i") {
    log_query query;
    query.instance = instance;
    query.offset = offset;
    query.wait_ms = wait_ms;
    return get<log_excerpt>(query);
  }

  process_runtime_config config;
  std::vector<std::string> instances;
};

/// Waits for a signal to end it.
inline const std::string endless = "while :; do sleep 60 & wait; done";

inline pid_t pid_of(const std::string& container) {
  return static_cast<pid_t>(std::stol(container));
}

/// The command's process, as the shim has recorded it.
inline pid_t child_of(const process_bench& b,
                      const std::string& instance = "i") {
  std::istringstream file{
      std::filesystem::read_symlink(b.config.instances_dir / instance / "pid")
          .string()};
  pid_t shim = 0;
  unsigned long long start = 0;
  pid_t child = 0;
  file >> shim >> start >> child;
  return child;
}

} // namespace roscell::test
