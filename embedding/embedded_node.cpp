#include "actors/node/limits.hpp"
#include "roscell/node.hpp"

#include "actors/instances/skills/skill_descriptor_file.hpp"
#include "actors/node/spawn_node.hpp"
#include "embedding/node_door.hpp"
#include "embedding/program_callbacks.hpp"
#include "embedding/skills/actor_runtime.hpp"
#include "embedding/surroundings.hpp"
#include "embedding/task_calls.hpp"

#include <caf/actor_system.hpp>
#include <caf/actor_system_config.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <utility>

namespace roscell {

namespace {

/// Its threads wait for work; CAF's default would look for it again and again.
class quiet_system_config : public caf::actor_system_config {
public:
  explicit quiet_system_config(std::size_t workers) {
    set("scheduler.policy", caf::atom("sharing"));
    set("scheduler.max-threads", std::max<std::size_t>(workers, 1));
    set("logger.verbosity", caf::atom("quiet"));
  }
};

/// An actor system and what it was made from, which it needs to the end.
struct owned_system {
  explicit owned_system(std::size_t workers)
      : config(workers), system(config) {}

  quiet_system_config config;
  caf::actor_system system;
};

/// Known once the node has ended, to any thread.
class end_mark {
public:
  void set() {
    {
      std::lock_guard<std::mutex> lock{mutex_};
      ended_ = true;
    }
    changed_.notify_all();
  }

  bool is_set() const {
    std::lock_guard<std::mutex> lock{mutex_};
    return ended_;
  }

  bool wait_for(std::chrono::milliseconds limit) {
    std::unique_lock<std::mutex> lock{mutex_};
    return changed_.wait_for(lock, limit, [this] { return ended_; });
  }

private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
};

node_error to_node_error(const caf::error& error) {
  const auto why = to_failure(error);
  return {std::string{to_string(why.code)},
          why.where.empty() ? why.message : why.where + ": " + why.message,
          why.hint};
}

/// The word after "operation" of each descriptor stands for its factory. The
/// node has read the descriptors by then, so that they are sound.
std::map<std::string, actor_skill_factory>
factories_of(const std::vector<actor_skill>& skills) {
  std::map<std::string, actor_skill_factory> result;
  for (const auto& x : skills) {
    const auto parsed =
        parse_descriptor(x.descriptor, format_of("", x.descriptor));
    if (const auto* known = std::get_if<skill_descriptor>(&parsed))
      result[known->operation] = x.make;
  }
  return result;
}

} // namespace

class embedded_node::impl {
public:
  impl(caf::actor_system* system, const node_setup& setup)
      : threads_(setup.threads) {
    embedding::check_surroundings();
    embedding::run_on_own_thread(setup.threads, [&] { start(system, setup); });
  }

  /// Its actors use the workers of its skills, which end here.
  ~impl() {
    stop(limits::membership::stopping);
  }

  bool stop(std::chrono::milliseconds limit) {
    if (!ended_->is_set())
      caf::anon_send(node_.actor, stop_node{});
    return ended_->wait_for(limit);
  }

  bool has_ended() const {
    return ended_->is_set();
  }

  const node_facts& facts() const {
    return node_;
  }

  const node_door_actor& door() const {
    return door_;
  }

  const embedding::task_door& tasks() const {
    return tasks_;
  }

  /// A thread for it is one of the node's, whoever asks.
  task_watch watch(const std::string& task,
                   const std::function<void(const task_status&)>& on_change) {
    std::shared_ptr<task_watch::impl> result;
    embedding::run_on_own_thread(threads_, [&] {
      result = embedding::watch_task(tasks_, task, on_change);
    });
    return task_watch{std::move(result)};
  }

private:
  void start(caf::actor_system* system, const node_setup& setup) {
    if (!setup.skills.empty())
      skills_ = std::make_unique<owned_system>(setup.threads.skill_workers);
    if (system == nullptr) {
      own_ = std::make_unique<owned_system>(setup.threads.workers);
      system = &own_->system;
    }
    auto node = spawn_node(*system, setup.node, additions(*system, setup));
    if (!node)
      throw to_node_error(node.error());
    node_ = std::move(*node);
    door_ = spawn<caf::detached>(
        *system, actor_context{node_.actors, node_.events},
        embedding::node_door,
        embedding::node_door_config{node_.actor, node_.router, node_.events});
    const actor_context context{node_.actors, node_.events};
    tasks_ = {system, node_.router, context};
    if (embedding::wants_to_hear(setup.calls)) {
      const auto listener = spawn<caf::detached>(
          *system, context, embedding::program_callbacks, node_.events,
          std::make_shared<const node_callbacks>(setup.calls));
      caf::anon_send(node_.events, subscribe_events{listener, 0});
    }
    node_.actor->attach_functor([ended = ended_] { ended->set(); });
  }

  node_additions additions(caf::actor_system& system, const node_setup& setup) {
    node_additions result;
    for (const auto& x : setup.skills)
      result.actor_skills.push_back(x.descriptor);
    if (skills_ == nullptr)
      return result;
    embedding::actor_runtime_config config;
    config.workers = &skills_->system;
    config.factories = factories_of(setup.skills);
    config.log_bytes = setup.node.log_bytes;
    result.make_actor_runtime =
        [&system, config](const actor_context& context,
                          const container_listener_actor& listener) {
          auto with = config;
          with.context = context;
          return runtime_actor{spawn<caf::detached>(
              system, context, embedding::actor_runtime, with, listener)};
        };
    return result;
  }

  // The node's actors end before the workers of its skills do.
  std::unique_ptr<owned_system> skills_;
  std::unique_ptr<owned_system> own_;
  running_node node_;
  node_door_actor door_;
  embedding::task_door tasks_;
  const node_threads threads_;
  const std::shared_ptr<end_mark> ended_ = std::make_shared<end_mark>();
};

embedded_node::embedded_node(const node_setup& setup)
    : impl_(std::make_unique<impl>(nullptr, setup)) {}

embedded_node::embedded_node(caf::actor_system& system, const node_setup& setup)
    : impl_(std::make_unique<impl>(&system, setup)) {}

embedded_node::~embedded_node() = default;

const node_facts& embedded_node::facts() const noexcept {
  return impl_->facts();
}

node_door_actor embedded_node::door() const {
  return impl_->door();
}

task_status embedded_node::run(const std::string& request,
                               std::chrono::milliseconds limit) {
  return state(embedding::run_task(impl_->tasks(), request, limit), limit);
}

void embedded_node::stop(const std::string& task, bool force,
                         std::chrono::milliseconds limit) {
  embedding::ask_node(impl_->tasks(),
                      message_json(task_termination{task, force}), limit);
}

task_status embedded_node::state(const std::string& task,
                                 std::chrono::milliseconds limit) const {
  return embedding::status_of_task(impl_->tasks(), task, limit);
}

task_watch
embedded_node::watch(const std::string& task,
                     std::function<void(const task_status&)> on_change) const {
  return impl_->watch(task, on_change);
}

bool embedded_node::stop(std::chrono::milliseconds limit) {
  return impl_->stop(limit);
}

bool embedded_node::has_ended() const {
  return impl_->has_ended();
}

} // namespace roscell
