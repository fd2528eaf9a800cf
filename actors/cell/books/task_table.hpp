#pragma once

#include "messages/coordination.hpp"

#include <caf/actor_addr.hpp>

#include <caf/typed_response_promise.hpp>

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// What of a task outlives the coordinator's process.
struct task_record {
  std::string task;
  std::string request;  ///< JSON of the task request, to compare bodies.
  std::string accepted; ///< JSON of the reply once all steps run.
  task_state state = task_state::deploying;
  int64_t submitted_unix_ms = 0;
  std::vector<instance_spec> specs;
  std::vector<std::string> nodes; ///< Node of each spec.

  static constexpr auto fields() {
    return std::make_tuple(
        required("task", &task_record::task),
        required("request", &task_record::request),
        required("accepted", &task_record::accepted),
        required("state", &task_record::state),
        required("submitted_unix_ms", &task_record::submitted_unix_ms),
        required("specs", &task_record::specs),
        required("nodes", &task_record::nodes));
  }
};

/// A task and who works on it or waits for it.
struct task_entry {
  task_record record;
  /// The pipeline that deploys it; its death rolls the task back.
  caf::actor_addr owner;
  bool intent = false; ///< The record has been written.
  std::vector<caf::typed_response_promise<task_claimed>> same_requests;
  std::vector<caf::typed_response_promise<task_terminated>> terminations;
};

/// The coordinator's table of tasks. Pure.
class task_table {
public:
  task_entry* find(const std::string& task);
  const task_entry* find(const std::string& task) const;
  task_entry* find_owned_by(const caf::actor_addr& owner);
  task_entry& add(task_record record);
  void erase(const std::string& task);

  void remember_ended(const task_terminated& reply);
  const task_terminated* find_ended(const std::string& task) const;

  /// The spec of an instance that shall run, and on which node; null if none.
  const instance_spec* find_spec(const std::string& instance,
                                 const std::string& node) const;

  /// Specs of the running tasks that belong on a node.
  std::vector<instance_spec> wanted_on(const std::string& node) const;

  /// Specs of all that is or will be on a node, of deploying tasks too.
  std::vector<instance_spec> bound_to(const std::string& node) const;

  /// Ids of the tasks that have some of these, each once.
  std::vector<std::string> tasks_bound_to(const std::string& node) const;

  /// Whether a task is being deployed to the node.
  bool is_deploying_on(const std::string& node) const;

  const std::map<std::string, task_entry>& entries() const {
    return entries_;
  }

private:
  std::map<std::string, task_entry> entries_;
  std::deque<task_terminated> ended_;
};

} // namespace roscell
