#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/cgroup/instance_cgroup.hpp"
#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/process/child_watch.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "messages/inside/runtime.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

/// How the process runtime deals with one instance's shim and folder. All of
/// it blocks, for some milliseconds, on processes and the disk.
namespace roscell {

struct process_runtime_config {
  actor_context context;
  std::filesystem::path instances_dir; ///< One folder per instance goes here.
  std::filesystem::path shim;          ///< tools/instance_shim.
  uint64_t log_bytes = 1024 * 1024;    ///< Bound of one instance's log.
  /// Logs of instances that are gone go here; empty: they are not kept.
  std::filesystem::path kept_logs;
  node_history_actor history;  ///< Told of each; may be invalid.
  std::shared_ptr<io_core> io; ///< Watches the programs.
  /// What every program sees besides what it is given.
  std::map<std::string, std::string> environment;
  cgroup_place cgroups; ///< Holds them to their limits; may be nowhere.
};

/// PATH, HOME and LANG of this process, with defaults for what it has not.
std::map<std::string, std::string> basic_environment();

/// A program that runs, or one that has ended.
struct process_instance {
  std::string container; ///< Empty: there never was one.
  shared_fd pidfd;       ///< Of the shim; null: it has ended.
  shared_fd notify_socket;
  int exit_code = -1;      ///< 128 + n after signal n; negative: not known.
  bool recorded = false;   ///< Its shim has written down how it ended,
  bool terminated = false; ///< and that it had been told to.
  end_cause cause = end_cause::usual;
  double most_memory_mib = -1; ///< That it ever had; negative: not known.
  instance_cgroup cgroup;      ///< None once it has ended.

  bool runs() const {
    return pidfd != nullptr;
  }
};

/// Starts the program, behind its fence if it has one, in the instance's
/// folder, of which only the log of its earlier runs is left. Errors:
/// engine_failed.
edge_result<process_instance> launch(const process_runtime_config& config,
                                     const start_container& request);

/// Finds what an earlier run of the node has started last, by the records in
/// the instance's folder or, where they are gone, by the container's id.
/// Errors: engine_failed (it runs, but its NOTIFY_SOCKET cannot be made).
edge_result<process_instance> take_over(const process_runtime_config& config,
                                        const std::string& instance,
                                        const std::string& container);

/// Notes that the shim has ended: reaps it and reads how its command ended.
void conclude(const process_runtime_config& config, const std::string& instance,
              process_instance& x);

/// Puts the log of an instance that has ended into the history.
void keep_log(const process_runtime_config& config, const kept_log& about);

/// Removes the folder, the socket, the fence and the cgroup of an instance that
/// has ended. Errors: engine_failed.
edge_result<bool> clean_up(const process_runtime_config& config,
                           const std::string& instance);

/// Ends and removes what is left of cgroups of instances that have no folder
/// any more.
void clear_cgroups(const process_runtime_config& config);

} // namespace roscell
