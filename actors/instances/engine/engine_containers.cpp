#include "actors/instances/engine/engine_parts.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/process/child_watch.hpp"
#include "actors/edge/process/fence_file.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "messages/failure.hpp"

#include <caf/send.hpp>

#include <system_error>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

caf::error bad_id(const std::string& instance) {
  return fail(error_code::engine_failed,
              "'" + instance + "' cannot be the name of a container");
}

engine_container* find_container(engine_runtime_pointer self,
                                 const std::string& instance) {
  auto& xs = self->state.containers;
  const auto i = xs.find(instance);
  return i != xs.end() ? &i->second : nullptr;
}

fs::path container_notify_path(const fs::path& data_dir,
                               const std::string& instance) {
  constexpr size_t digits = 16;
  return data_dir / "notify"
         / to_hex(hmac_sha256("roscell instance", instance)).substr(0, digits)
         / notify_socket_name;
}

fs::path notify_dir(engine_runtime_pointer self, const std::string& instance) {
  return container_notify_path(self->state.config.data_dir, instance)
      .parent_path();
}

fs::path fence_file(engine_runtime_pointer self, const std::string& instance) {
  return fence_path(notify_dir(self, instance));
}

fs::path exit_file(engine_runtime_pointer self, const std::string& instance) {
  return notify_dir(self, instance) / exit_record_name;
}

fs::path shim_file(engine_runtime_pointer self) {
  return self->state.config.data_dir / "instance-shim";
}

caf::error open_status(engine_runtime_pointer self, const std::string& instance,
                       engine_container& x) {
  const auto dir = notify_dir(self, instance);
  std::error_code problem;
  fs::create_directories(dir, problem);
  auto socket = open_notify_socket(dir / notify_socket_name);
  if (auto* error = std::get_if<edge_error>(&socket))
    return to_caf(*error);
  // Nobody else may speak for the instance.
  fs::permissions(dir, fs::perms::owner_all, problem);
  x.notify_socket = share(std::get<unique_fd>(std::move(socket)));
  x.notifications = watch_notifications(
      self->state.config.io, x.notify_socket,
      [listener = self->state.listener, instance](const notification& n) {
        caf::anon_send(listener, status_notification(instance, n, false));
      });
  return {};
}

void hear(engine_runtime_pointer self, const std::string& instance) {
  const auto& st = self->state;
  const auto forward_notification = [listener = st.listener,
                                     instance](const notification& n) {
    caf::anon_send(listener, status_notification(instance, n, true));
  };
  const auto* x = find_container(self, instance);
  if (x == nullptr || !x->notify_socket)
    return forward_notification({});
  hear_notifications(st.config.io, x->notify_socket, forward_notification);
}

void forget(engine_runtime_pointer self, const std::string& instance) {
  auto& xs = self->state.containers;
  const auto i = xs.find(instance);
  if (i == xs.end())
    return;
  const auto waiting = std::move(i->second.waiting);
  xs.erase(i);
  for (const auto& request : waiting)
    request();
}

void settle(engine_runtime_pointer self, const std::string& instance,
            const std::string& id) {
  auto* x = find_container(self, instance);
  if (x == nullptr)
    return;
  x->id = id;
  x->settling = false;
  const auto waiting = std::exchange(x->waiting, {});
  if (const auto code = x->early_exit)
    on_container_ended(self, instance, id, *code);
  for (const auto& request : waiting)
    request();
}

engine_request to_container(std::string method, const std::string& container,
                            const std::string& what,
                            std::chrono::milliseconds limit) {
  engine_request result;
  result.method = std::move(method);
  result.target = "/containers/" + percent_encode(container) + what;
  result.limit = limit;
  return result;
}

std::string target_of(const std::string& container,
                      const std::string& instance) {
  return container.empty() ? container_name(instance) : container;
}

int exit_code_of(const json& container) {
  const auto code = number_at(object_at(container, "State"), "ExitCode", -1);
  return is_running(container) || code < 0 || code > 255
             ? -1
             : static_cast<int>(code);
}

bool is_running(const json& container) {
  return flag_at(object_at(container, "State"), "Running");
}

void clean_up(engine_runtime_pointer self, const std::string& instance) {
  std::error_code ignored;
  remove_fence(fence_file(self, instance));
  fs::remove_all(notify_dir(self, instance), ignored);
}

end_cause cause_of(const json& container,
                   const std::optional<recorded_end>& end, int exit_code) {
  const bool ran_out = flag_at(object_at(container, "State"), "OOMKilled")
                       || (end && end->memory_kills > 0);
  return exit_code != 0 && ran_out ? end_cause::memory : end_cause::usual;
}

namespace {

void publish_transfer_end(engine_runtime_pointer self,
                          const std::string& instance, const std::string& id,
                          int exit_code, const json& inspected) {
  auto& st = self->state;
  auto* x = find_container(self, instance);
  if (x == nullptr || (!x->id.empty() && x->id != id))
    return;
  // What the program said last must not come after its end.
  const auto notified = receive_notifications(x->notify_socket->get());
  if (notified.ready || notified.stopping || !notified.status.empty())
    self->send(st.listener, status_notification(instance, notified, false));
  const auto end = read_exit_record(notify_dir(self, instance));
  self->send(st.listener,
             container_exited{instance, id, exit_code, end && end->terminated,
                              cause_of(inspected, end, exit_code),
                              end ? end->most_memory_mib : -1});
  forget(self, instance);
}

} // namespace

void on_container_ended(engine_runtime_pointer self,
                        const std::string& instance, const std::string& id,
                        int exit_code) {
  auto* x = find_container(self, instance);
  if (x == nullptr || (!x->id.empty() && x->id != id))
    return;
  if (x->settling) {
    x->early_exit = exit_code;
    return;
  }
  if (exit_code == 0)
    return publish_transfer_end(self, instance, id, exit_code, {});
  // Why it was killed stands nowhere but there.
  ask_engine(self, to_container("GET", id, "/json"),
             [=](const engine_answered& answer) {
               publish_transfer_end(self, instance, id, exit_code,
                                    object_of(answer));
             });
}

} // namespace roscell
