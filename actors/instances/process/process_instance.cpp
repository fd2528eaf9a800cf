#include "actors/instances/process/process_instance.hpp"

#include "actors/edge/history/kept_log_folder.hpp"
#include "actors/edge/process/fence_file.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/edge/process/parameter_file.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "actors/instances/limits.hpp"
#include "actors/instances/process/shim_program.hpp"
#include "messages/inside/storage.hpp"

#include <caf/send.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// What an exit code has above the number of the signal.
constexpr int signal_base = 128;

edge_error failed(const std::string& what, const fs::path& path,
                  const std::string& why, std::string hint = {}) {
  return {error_code::engine_failed, what + " '" + path.string() + "': " + why,
          std::move(hint)};
}

edge_error no_folder(const fs::path& path, const std::string& why) {
  return failed("cannot make the instance's folder", path, why,
                "check that the data directory is writable and has room");
}

bool is_log_file(const fs::path& path) {
  const auto name = path.filename().native();
  return name.rfind("log.", 0) == 0 || name.rfind("times.", 0) == 0;
}

/// Removes what earlier runs have left, but for their log: the instance is the
/// same, and its log goes on.
void clear_folder(const fs::path& dir, std::error_code& error) {
  if (!fs::is_directory(fs::symlink_status(dir, error))) {
    error.clear();
    fs::remove(dir, error);
    return;
  }
  std::vector<fs::path> left;
  for (fs::directory_iterator i{dir, error}, end; !error && i != end;
       i.increment(error))
    if (!is_log_file(i->path()))
      left.push_back(i->path());
  for (const auto& x : left)
    if (!error)
      fs::remove_all(x, error);
}

edge_result<unique_fd> ready_folder(const fs::path& dir) {
  std::error_code error;
  fs::create_directories(dir.parent_path(), error);
  if (!error)
    clear_folder(dir, error);
  if (error)
    return no_folder(dir, error.message());
  if (::mkdir(dir.c_str(), 0700) != 0 && errno != EEXIST)
    return no_folder(dir, std::strerror(errno));
  auto socket = open_notify_socket(notify_path(dir));
  make_environment_file(environment_file_of(notify_path(dir)));
  make_parameter_file(parameter_file_of(notify_path(dir)));
  return socket;
}

/// A shim that was killed has left no record, and maybe programs: its command
/// dies with it, but not what the command has started in sessions of their own.
/// Without a record, readers of the log would wait for more.
void clear_up_after_killed_shim(const fs::path& dir,
                                const instance_cgroup& cgroup) {
  std::error_code error;
  if (!fs::is_directory(dir, error)
      || fs::exists(dir / exit_record_name, error))
    return;
  cgroup.kill();
  kill_marked_processes(folder_variable, dir.string());
  std::ofstream{dir / exit_record_name} << R"({"code":null,"signal":null})"
                                        << '\n';
}

/// What its shim has written down of its end; with another exit code where it
/// has not.
void take_end(const fs::path& dir, process_instance& x, int otherwise) {
  const auto end = read_exit_record(dir);
  x.recorded = end.has_value();
  x.exit_code = end ? end->exit_code : otherwise;
  x.terminated = end && end->terminated;
  // A program that has ended well has not missed what was ended.
  if (end && end->memory_kills > 0 && end->exit_code != 0)
    x.cause = end_cause::memory;
  if (end)
    x.most_memory_mib = end->most_memory_mib;
}

std::string variable(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : otherwise;
}

} // namespace

std::map<std::string, std::string> basic_environment() {
  return {{"PATH", variable("PATH", "/usr/local/bin:/usr/bin:/bin")},
          {"HOME", variable("HOME", "/")},
          {"LANG", variable("LANG", "C.UTF-8")}};
}

edge_result<process_instance> launch(const process_runtime_config& config,
                                     const start_container& request) {
  const auto dir = config.instances_dir / request.instance;
  auto socket = ready_folder(dir);
  if (auto* error = std::get_if<edge_error>(&socket))
    return *error;
  if (request.fence_boot_ms != 0)
    if (auto error = make_fence(fence_path(dir), request.fence_boot_ms))
      return *error;
  const auto cgroup = instance_cgroup::make(config.cgroups, request.instance,
                                            bounds_of(request));
  cgroup.record(dir);
  auto shim = shim_for(config, dir, request, cgroup);
  if (auto error = add_identity(request, shim))
    return *error;
  if (auto error = let_in(request, dir))
    return *error;
  auto started = spawn_program(shim, limits::instance::shim);
  if (auto* error = std::get_if<edge_error>(&started)) {
    clear_up_after_killed_shim(dir, cgroup);
    drop_cgroup(config, request.instance, cgroup);
    return *error;
  }
  auto& child = std::get<spawned_program>(started);
  process_instance result;
  result.container = to_container(child.identity);
  result.pidfd = share(std::move(child.pidfd));
  result.notify_socket = share(std::move(std::get<unique_fd>(socket)));
  result.cgroup = cgroup;
  return result;
}

edge_result<process_instance> take_over(const process_runtime_config& config,
                                        const std::string& instance,
                                        const std::string& container) {
  const auto dir = config.instances_dir / instance;
  // A node that was killed may know no more than the program of an earlier run;
  // the folder has the record of the last one that was started in it.
  auto process = read_pid_record(dir);
  if (!process)
    process = process_of(container);
  process_instance result;
  if (!process)
    return result;
  result.container = to_container(*process);
  const auto cgroup = cgroup_of(config, instance);
  auto pidfd = open_process(*process, '/' + instance);
  if (!pidfd || has_ended(pidfd.get())) {
    if (pidfd)
      reap(pidfd.get());
    clear_up_after_killed_shim(dir, cgroup);
    take_end(dir, result, -1);
    if (!result.recorded)
      result.cause = end_cause::supervision;
    drop_cgroup(config, instance, cgroup);
    return result;
  }
  result.cgroup = cgroup;
  auto socket = open_notify_socket(notify_path(dir));
  if (auto* error = std::get_if<edge_error>(&socket))
    return *error;
  result.pidfd = share(std::move(pidfd));
  result.notify_socket = share(std::move(std::get<unique_fd>(socket)));
  return result;
}

void conclude(const process_runtime_config& config, const std::string& instance,
              process_instance& x) {
  const auto dir = config.instances_dir / instance;
  const auto shim_code = reap(x.pidfd->get()).value_or(0);
  clear_up_after_killed_shim(dir, x.cgroup);
  // A shim that did its work ends with 0, whatever became of its command.
  take_end(dir, x, shim_code != 0 ? shim_code : -1);
  // Of one that an earlier run of the node has started there is no code.
  if (!x.recorded && (shim_code == 0 || shim_code > signal_base)) {
    x.cause = end_cause::supervision;
    x.exit_code = -1;
  }
  drop_cgroup(config, instance, std::exchange(x.cgroup, {}));
  x.pidfd = nullptr;
  x.notify_socket = nullptr;
}

void keep_log(const process_runtime_config& config, const kept_log& about) {
  if (config.kept_logs.empty())
    return;
  kept_log_folder history{config.kept_logs};
  if (history.keep(config.instances_dir / about.instance, about)
      && config.history)
    caf::anon_send(config.history, log_kept{});
}

edge_result<bool> clean_up(const process_runtime_config& config,
                           const std::string& instance) {
  const auto dir = config.instances_dir / instance;
  std::error_code error;
  drop_cgroup(config, instance, cgroup_of(config, instance));
  // The folder goes last: it is by this that the rest is found.
  fs::remove(notify_path(dir), error);
  fs::remove(environment_file_of(notify_path(dir)), error);
  fs::remove(parameter_file_of(notify_path(dir)), error);
  remove_fence(fence_path(dir));
  fs::remove_all(dir, error);
  if (error)
    return failed("cannot remove the instance's folder", dir, error.message());
  return true;
}

} // namespace roscell
