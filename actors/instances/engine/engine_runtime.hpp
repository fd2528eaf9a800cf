#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/core/backoff.hpp"
#include "actors/edge/engine/build_context.hpp"
#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/engine/registry_login.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/instances/engine/container_document.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace roscell {

struct engine_runtime_config {
  actor_context context;
  std::string socket; ///< The engine's Unix socket.
  std::string api;    ///< Version of Docker's API; empty: the engine's own.
  container_setting setting;
  std::filesystem::path shim; ///< tools/instance_shim, for fences.
  /// notify/, build/ and a copy of the shim go below it: the engine may be
  /// outside of the container that this node is in, and sees this folder.
  std::filesystem::path data_dir;
  std::shared_ptr<io_core> io;
  /// The logs of containers that are removed go here; empty: they are not kept.
  std::filesystem::path kept_logs;
  node_history_actor history; ///< Told of each; may be invalid.
  /// Gets images from other nodes; invalid: they come from registries only.
  image_exchange_actor images{};
  login_places logins{};   ///< For registries.
  size_t kept_images = 20; ///< That no container has.
};

/// A container that runs, or may soon.
struct engine_container {
  std::string id;                ///< Empty: not known yet.
  bool settling = false;         ///< It is being started, or looked for.
  std::optional<int> early_exit; ///< It ended while `settling`.
  bool fence_fails = false;      ///< Its fence could not be moved on.
  /// What was asked meanwhile.
  std::vector<std::function<void()>> waiting;
  shared_fd notify_socket;
  fd_watch notifications;
};

/// An image that is being made ready, for whoever has asked for it.
struct image_work {
  struct waiter {
    std::string instance;
    caf::typed_response_promise<image_prepared> promise;
  };

  prepare_image request; ///< The first one.
  std::vector<waiter> waiters;
  image_packer_actor packer; ///< Null: not needed so far.
  std::string image;
  std::string context; ///< Tar file of the build; empty: none.
  engine_stream build;
  uint64_t call = 0;           ///< Of `build`.
  std::deque<std::string> log; ///< The last lines of the build.
  std::string error;           ///< What the engine says went wrong.
  bool has_base = false;       ///< The base image was found.
  std::string base;            ///< Its id, where the engine needs that.
  /// While it is pulled: when its registry has said nothing for too long.
  std::optional<alarm::time_point> silent_at;
  std::string step;              ///< How it gets on, not told yet.
  alarm::time_point next_status; ///< Not before is it told.
  alarm::time_point began;
};

/// Someone who waits for more of a log.
struct engine_log_follower {
  caf::typed_response_promise<log_excerpt> promise;
  log_query query;
  bool running = false; ///< More may come after the end of what is there.
  std::optional<alarm::time_point> until;
  engine_stream stream;
};

/// How an image is called that has been planned.
struct image_plan {
  std::string image;
  file_marks made_of; ///< As of then.
};

/// The log of a container that goes, on its way into the history.
struct engine_log_reading {
  kept_log about;
  std::function<void()> then; ///< Called once: removes the container.
  engine_stream stream;
};

/// Owns the containers of the node. It looks at files before it starts one, so
/// it is spawned as one that blocks. Ends with its listener; the containers go
/// on.
struct engine_runtime_state {
  static constexpr const char* name = "engine-runtime";

  using continuation = std::function<void(const engine_answered&)>;

  engine_runtime_config config;
  container_listener_actor listener;
  std::unique_ptr<engine_client> client;

  uint64_t last_call = 0;
  std::map<uint64_t, continuation> calls;

  /// The one stream of events, by which exits are heard.
  engine_stream events;
  uint64_t events_call = 0;
  bool connected = false; ///< `events` is open.
  std::string problem; ///< Why it is not; empty: it is, or was not yet tried.
  backoff pause;
  std::optional<alarm::time_point> next_attempt;

  std::map<std::string, engine_container> containers;   ///< By instance.
  std::map<std::string, image_plan> plans;              ///< By key.
  std::map<std::string, image_work> works;              ///< By key.
  std::map<std::string, std::string> named;             ///< By instance.
  std::map<uint64_t, engine_log_follower> followers;    ///< By call.
  std::map<uint64_t, engine_log_reading> readings;      ///< By call.
  std::vector<std::function<void()>> waiting_adoptions; ///< For a connection.
  bool has_shim = false; ///< The copy is that of this version.
  /// Instances whose containers must go, once the engine can be asked.
  std::set<std::string> unwanted;
  alarm timer;
};

/// The NOTIFY_SOCKET of an instance on the host, in a folder with a short path,
/// for that of a Unix socket must be, whatever the instance's name is. The
/// container sees nothing but this folder.
std::filesystem::path
container_notify_path(const std::filesystem::path& data_dir,
                      const std::string& instance);

/// The ENGINE RUNTIME. Messages: messages/inside/runtime.hpp,
/// messages/inside/engine.hpp.
engine_runtime_actor::behavior_type engine_runtime(
    engine_runtime_actor::stateful_pointer<engine_runtime_state> self,
    const engine_runtime_config& config, container_listener_actor listener);

} // namespace roscell
