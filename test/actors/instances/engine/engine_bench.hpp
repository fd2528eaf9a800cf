#pragma once

#include "actors/edge/disk/folder_hash.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/instances/engine/engine_runtime.hpp"
#include "test/actors/instances/process/process_bench.hpp"
#include "test/fake_engine.hpp"
#include "test/places.hpp"

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

/// The engine runtime and an engine whose answers a test chooses.
namespace roscell::test {

/// Answers by the beginning of "METHOD /path". A stream of events stays open
/// until the engine ends.
class engine_script {
public:
  using answer = fake_engine::handler;

  void on(const std::string& call, answer what) {
    const std::lock_guard guard{mutex_};
    answers_[call] = std::move(what);
  }

  void on(const std::string& call, int status, const std::string& body = "{}") {
    on(call, [=](engine_caller& who, const engine_call_seen&) {
      who.reply(status, body);
    });
  }

  void handle(engine_caller& who, const engine_call_seen& what) {
    const auto call = what.method + ' ' + what.target;
    answer chosen;
    {
      const std::lock_guard guard{mutex_};
      calls_.put(call);
      listed_ = listed_ || call.rfind("GET /containers/json", 0) == 0;
      listening_.notify_all();
      // The longest that fits.
      for (const auto& [begin, x] : answers_)
        if (call.rfind(begin, 0) == 0)
          chosen = x;
    }
    if (chosen)
      chosen(who, what);
    else if (call.rfind("GET /events", 0) == 0)
      open_events(who);
    else if (call.rfind("GET /containers/json", 0) == 0)
      who.reply(200, "[]");
    else
      who.reply(404, R"({"message":"none"})");
  }

  /// Sends an event once somebody listens.
  void publish_transfer_end(const std::string& instance, const std::string& id,
                            int code) {
    const json event{{"Action", "die"},
                     {"Actor",
                      {{"ID", id},
                       {"Attributes",
                        {{"roscell.instance", instance},
                         {"exitCode", std::to_string(code)}}}}}};
    std::unique_lock lock{mutex_};
    listening_.wait_for(lock, patience, [this] { return events_ != nullptr; });
    events_->chunk(event.dump() + "\n");
  }

  /// Until the runtime hears events and has asked what runs: it compares that
  /// with what it has started before.
  void await_listing() {
    std::unique_lock lock{mutex_};
    listening_.wait_for(lock, patience, [this] { return listed_; });
  }

  /// What was asked, one by one.
  event_inbox& calls() {
    return calls_;
  }

private:
  void open_events(engine_caller& who) {
    who.open();
    const std::lock_guard guard{mutex_};
    events_ = &who;
    listening_.notify_all();
  }

  std::mutex mutex_;
  std::map<std::string, answer> answers_;
  std::condition_variable listening_;
  engine_caller* events_ = nullptr;
  bool listed_ = false;
  event_inbox calls_;
};

struct engine_bench : runtime_bench<engine_runtime_actor> {
  engine_bench() {
    config.context = context;
    config.context.events = events = keep_events(system, reported_events);
    config.shim =
        std::filesystem::path{test::build_dir()} / "bin/roscell-instance-shim";
    config.socket = folder.path() / "engine";
    config.setting = {"uuid", 1024 * 1024};
    config.data_dir = folder.path() / "data";
    config.io = io.core();
    std::filesystem::create_directories(config.data_dir);
    using handle = container_listener_actor;
    listener = system.spawn([this](handle::pointer) -> handle::behavior_type {
      return {
          [this](const container_exited& x) {
            reported.put("exit " + x.container + " " + text_of_end(x));
          },
          [this](const instance_notified& x) {
            reported.put("says " + x.status);
          },
          [this](const runtime_problem_changed& x) {
            reported.put(x.message.empty() ? "no trouble" : "trouble");
          },
      };
    });
    folder.write("skill/bin/run", "#!/bin/sh\n", true);
    script.on("GET /images/base:1/json", 200);
    begin_engine();
    begin_runtime();
    script.await_listing();
  }

  ~engine_bench() {
    end_and_await(self, runtime);
    end_and_await(self, listener);
    end_and_await(self, events);
    engine = nullptr;
  }

  void begin_engine() {
    engine = std::make_unique<fake_engine>(
        config.socket,
        [this](engine_caller& who, const engine_call_seen& what) {
          script.handle(who, what);
        });
  }

  void begin_runtime() {
    runtime = roscell::spawn<caf::detached>(system, context, engine_runtime,
                                            config, listener);
  }

  prepare_image image(const std::string& instance = "i") const {
    const auto skill = folder.path() / "skill";
    return {instance,
            "echo",
            skill.string(),
            std::get<std::string>(hash_folder(skill)),
            {},
            {"bin/run"},
            "base:1"};
  }

  start_container container() const {
    start_container order;
    order.instance = "i";
    order.image = "roscell/echo:1";
    order.command = {"bin/run"};
    return order;
  }

  /// The script for a container that starts.
  void will_start() {
    script.on("POST /containers/create", 201, R"({"Id":"c1"})");
    script.on("POST /containers/c1/start", 204, "");
  }

  engine_script script;
  std::unique_ptr<fake_engine> engine;
  engine_runtime_config config;
};

} // namespace roscell::test
