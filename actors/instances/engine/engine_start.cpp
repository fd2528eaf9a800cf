#include "actors/core/edge_failure.hpp"
#include "actors/edge/engine/limits.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/fence_file.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/edge/process/parameter_file.hpp"
#include "actors/instances/engine/container_document.hpp"
#include "actors/instances/engine/engine_parts.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "messages/failure.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

bool is_podman(engine_runtime_pointer self) {
  return self->state.config.setting.engine == "podman";
}

caf::error runs_already(const std::string& instance) {
  return fail(error_code::engine_failed,
              "the instance '" + instance + "' runs already");
}

/// One start from its request to its answer.
struct start_attempt {
  start_container request;
  std::string body;
  caf::typed_response_promise<container_started> promise;
  bool name_was_taken = false;
};

using shared_attempt = std::shared_ptr<start_attempt>;

/// Whether there is a container is not known if the engine went away.
void give_up(engine_runtime_pointer self, const shared_attempt& x, bool lost,
             const caf::error& why) {
  const auto& instance = x->request.instance;
  if (lost)
    self->state.unwanted.insert(instance);
  x->promise.deliver(why);
  forget(self, instance);
}

void create(engine_runtime_pointer self, const shared_attempt& x);

/// Podman has the status of its own defects for it.
bool is_name_taken(const engine_answered& answer) {
  return answer.status == 409
         || (answer.status == 500
             && answer.body.find("already in use") != std::string::npos);
}

void on_started(engine_runtime_pointer self, const shared_attempt& x,
                const std::string& id, const engine_answered& answer) {
  if (is_good(answer) || answer.status == 304) {
    x->promise.deliver(container_started{id});
    return settle(self, x->request.instance, id);
  }
  const auto why = engine_failure("the container cannot be started", answer);
  if (is_lost(answer))
    return give_up(self, x, true, why);
  ask_engine(self, to_container("DELETE", id, "?force=true&v=true"),
             [=](const engine_answered& removed) {
               give_up(self, x, is_lost(removed), why);
             });
}

/// A container that has ended makes room for its successor.
void make_room(engine_runtime_pointer self, const shared_attempt& x) {
  const auto name = container_name(x->request.instance);
  ask_engine(
      self, to_container("GET", name, "/json"), [=](const engine_answered& y) {
        if (is_lost(y))
          return give_up(self, x, false,
                         engine_failure("the container cannot be created", y));
        if (is_running(object_of(y)))
          return give_up(self, x, false, runs_already(x->request.instance));
        ask_engine(self, to_container("DELETE", name, "?force=true&v=true"),
                   [=](const engine_answered&) { create(self, x); });
      });
}

void on_created(engine_runtime_pointer self, const shared_attempt& x,
                const engine_answered& answer) {
  if (is_name_taken(answer) && !std::exchange(x->name_was_taken, true))
    return make_room(self, x);
  const auto id = text_at(object_of(answer), "Id");
  if (!is_good(answer) || id.empty())
    return give_up(self, x, is_lost(answer),
                   engine_failure("the container cannot be created", answer));
  if (auto* container = find_container(self, x->request.instance))
    container->id = id;
  ask_engine(self, to_container("POST", id, "/start", limits::engine::start),
             [=](const engine_answered& y) { on_started(self, x, id, y); });
}

void create(engine_runtime_pointer self, const shared_attempt& x) {
  engine_request request;
  request.method = "POST";
  request.target =
      is_podman(self)
          ? std::string{podman_api} + "/containers/create"
          : "/containers/create?name="
                + percent_encode(container_name(x->request.instance));
  request.body = x->body;
  request.limit = limits::engine::create;
  ask_engine(self, std::move(request),
             [=](const engine_answered& y) { on_created(self, x, y); });
}

json body_of(engine_runtime_pointer self, const start_container& request,
             const container_files& files) {
  const auto& config = self->state.config;
  auto document = container_document(
      request, files, config.setting,
      notify_dir(self, request.instance).string(),
      {shim_file(self).string(), exit_file(self, request.instance).string(),
       fence_file(self, request.instance).string()});
  return is_podman(self)
             ? podman_document(container_name(request.instance), document)
             : document;
}

/// The containers that run keep the copy that they were started with.
caf::error copy_shim(engine_runtime_pointer self) {
  auto& st = self->state;
  if (st.has_shim)
    return {};
  const auto copy = shim_file(self);
  const auto part = copy.string() + ".part";
  std::error_code problem;
  fs::copy_file(st.config.shim, part, fs::copy_options::overwrite_existing,
                problem);
  if (!problem)
    fs::rename(part, copy, problem);
  if (problem)
    return fail(error_code::engine_failed,
                "cannot copy the instance shim '" + st.config.shim.string()
                    + "' to '" + copy.string() + "': " + problem.message(),
                "",
                "install roscell-instance-shim beside roscell, or in "
                "../lib/roscell; the data directory must be writable");
  st.has_shim = true;
  return {};
}

/// Nothing where there is no fence to be set up.
caf::error set_fence(engine_runtime_pointer self,
                     const start_container& request) {
  if (request.fence_boot_ms == 0)
    return {};
  const auto why =
      make_fence(fence_file(self, request.instance), request.fence_boot_ms);
  return why ? to_caf(*why) : caf::error{};
}

/// An empty file, on a disk that may be full when it is written to.
caf::error make_exit_file(engine_runtime_pointer self,
                          const std::string& instance) {
  constexpr off_t room = 256;
  const auto path = exit_file(self, instance);
  ::unlink(path.c_str());
  const unique_fd file{::open(path.c_str(),
                              O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                              S_IRUSR | S_IWUSR)};
  if (!file)
    return fail(error_code::engine_failed,
                "cannot make '" + path.string() + "': " + std::strerror(errno),
                "", "the data directory must be writable");
  ::posix_fallocate(file.get(), 0, room);
  return {};
}

} // namespace

caf::result<container_started> start(engine_runtime_pointer self,
                                     const start_container& request) {
  if (!is_instance_id(request.instance) || request.command.empty())
    return bad_id(request.instance);
  if (find_container(self, request.instance) != nullptr)
    return runs_already(request.instance);
  const auto files = files_of(request);
  if (const auto* error = std::get_if<edge_error>(&files))
    return to_caf(*error);
  if (auto error = copy_shim(self))
    return error;
  if (auto error = set_fence(self, request))
    return error;
  engine_container fresh;
  if (auto error = open_status(self, request.instance, fresh))
    return error;
  if (auto error = make_exit_file(self, request.instance))
    return error;
  const auto socket =
      container_notify_path(self->state.config.data_dir, request.instance);
  make_environment_file(environment_file_of(socket));
  make_parameter_file(parameter_file_of(socket));
  fresh.settling = true;
  auto& st = self->state;
  st.unwanted.erase(request.instance);
  st.containers[request.instance] = std::move(fresh);
  auto attempt = std::make_shared<start_attempt>();
  attempt->request = request;
  attempt->promise = self->make_response_promise<container_started>();
  attempt->body = body_of(self, request, std::get<container_files>(files))
                      .dump(-1, ' ', false, json::error_handler_t::replace);
  create(self, attempt);
  return attempt->promise;
}

} // namespace roscell
