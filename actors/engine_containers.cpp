#include "actors/edge/child_watch.hpp"
#include "actors/edge/crypto.hpp"
#include "actors/edge/notify_socket.hpp"
#include "actors/engine_parts.hpp"
#include "actors/instance_id.hpp"
#include "messages/failure.hpp"

#include <caf/send.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

using self_pointer = engine_runtime_pointer;
using namespace std::chrono_literals;

namespace fs = std::filesystem;

/// Longest time between the polite request to end and force.
constexpr int64_t max_grace_ms = 60'000;

/// Creating one copies nothing, but a loaded engine takes its time.
constexpr auto create_limit = 20s;
constexpr auto start_limit = 20s;

/// For an engine to kill what does not obey, beyond the grace.
constexpr auto force_limit = 10s;

caf::error to_caf(const edge_error& why) {
  return fail(why.code, why.message, {}, why.hint);
}

caf::error bad_id(const std::string& instance) {
  return fail(error_code::engine_failed,
              "'" + instance + "' cannot be the name of a container");
}

caf::error runs_already(const std::string& instance) {
  return fail(error_code::engine_failed,
              "the instance '" + instance + "' runs already");
}

engine_container* find_container(self_pointer self,
                                 const std::string& instance) {
  auto& xs = self->state.containers;
  const auto i = xs.find(instance);
  return i != xs.end() ? &i->second : nullptr;
}

/// A short path, for that of a Unix socket must be, whatever the instance's
/// name is. The container sees nothing but this folder.
fs::path notify_dir(self_pointer self, const std::string& instance) {
  constexpr size_t digits = 16;
  return self->state.config.data_dir / "notify"
         / to_hex(hmac_sha256("roscell instance", instance)).substr(0, digits);
}

/// Makes the NOTIFY_SOCKET and listens to it.
caf::error open_words(self_pointer self, const std::string& instance,
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
  x.words = watch_notifications(
      self->state.config.io, x.notify_socket,
      [listener = self->state.listener, instance](const notification& n) {
        caf::anon_send(listener, instance_notified{instance, n.ready, n.alive,
                                                   n.stopping, n.status});
      });
  return {};
}

/// Forgets it; whatever waited goes on.
void forget(self_pointer self, const std::string& instance) {
  auto& xs = self->state.containers;
  const auto i = xs.find(instance);
  if (i == xs.end())
    return;
  const auto waiting = std::move(i->second.waiting);
  xs.erase(i);
  for (const auto& request : waiting)
    request();
}

/// It runs, and everybody may know.
void settle(self_pointer self, const std::string& instance,
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
                            std::chrono::milliseconds limit = 10s) {
  engine_request result;
  result.method = std::move(method);
  result.target = "/containers/" + percent_encoded(container) + what;
  result.limit = limit;
  return result;
}

/// What a request means: its container, or the present one of the instance.
std::string target_of(const std::string& container,
                      const std::string& instance) {
  return container.empty() ? container_name(instance) : container;
}

/// One start from its request to its answer.
struct start_attempt {
  start_container wish;
  std::string body;
  caf::typed_response_promise<container_started> promise;
  bool name_was_taken = false;
};

using shared_attempt = std::shared_ptr<start_attempt>;

/// Whether there is a container is not known if the engine went away.
void give_up(self_pointer self, const shared_attempt& x, bool lost,
             const caf::error& why) {
  const auto& instance = x->wish.instance;
  if (lost)
    self->state.unwanted.insert(instance);
  x->promise.deliver(why);
  forget(self, instance);
}

void create(self_pointer self, const shared_attempt& x);

void on_started(self_pointer self, const shared_attempt& x,
                const std::string& id, const engine_answered& answer) {
  if (is_good(answer) || answer.status == 304) {
    x->promise.deliver(container_started{id});
    return settle(self, x->wish.instance, id);
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
void make_room(self_pointer self, const shared_attempt& x) {
  const auto name = container_name(x->wish.instance);
  ask_engine(
      self, to_container("GET", name, "/json"), [=](const engine_answered& y) {
        if (is_lost(y))
          return give_up(self, x, false,
                         engine_failure("the container cannot be created", y));
        if (is_running(object_of(y)))
          return give_up(self, x, false, runs_already(x->wish.instance));
        ask_engine(self, to_container("DELETE", name, "?force=true&v=true"),
                   [=](const engine_answered&) { create(self, x); });
      });
}

void on_created(self_pointer self, const shared_attempt& x,
                const engine_answered& answer) {
  if (answer.status == 409 && !std::exchange(x->name_was_taken, true))
    return make_room(self, x);
  const auto id = text_at(object_of(answer), "Id");
  if (!is_good(answer) || id.empty())
    return give_up(self, x, is_lost(answer),
                   engine_failure("the container cannot be created", answer));
  if (auto* container = find_container(self, x->wish.instance))
    container->id = id;
  ask_engine(self, to_container("POST", id, "/start", start_limit),
             [=](const engine_answered& y) { on_started(self, x, id, y); });
}

void create(self_pointer self, const shared_attempt& x) {
  engine_request request;
  request.method = "POST";
  request.target = "/containers/create?name="
                   + percent_encoded(container_name(x->wish.instance));
  request.body = x->body;
  request.limit = create_limit;
  ask_engine(self, std::move(request),
             [=](const engine_answered& y) { on_created(self, x, y); });
}

using stop_promise = caf::typed_response_promise<container_stopped>;

void answer_stopped(self_pointer self, const std::string& target,
                    stop_promise promise) {
  ask_engine(self, to_container("GET", target, "/json"),
             [promise](const engine_answered& x) mutable {
               promise.deliver(container_stopped{exit_code_of(object_of(x))});
             });
}

void do_stop(self_pointer self, const stop_container& wish,
             stop_promise promise) {
  const auto target = target_of(wish.container, wish.instance);
  const auto grace_ms = std::clamp<int64_t>(wish.grace_ms, 0, max_grace_ms);
  const auto seconds = std::to_string((grace_ms + 999) / 1000);
  ask_engine(self,
             to_container("POST", target, "/stop?t=" + seconds,
                          std::chrono::milliseconds{grace_ms} + force_limit),
             [=](const engine_answered& x) mutable {
               if (is_lost(x))
                 self->state.unwanted.insert(wish.instance);
               if (is_good(x) || x.status == 304)
                 answer_stopped(self, target, promise);
               else if (x.status == 404)
                 promise.deliver(container_stopped{});
               else
                 promise.deliver(
                     engine_failure("the container cannot be ended", x));
             });
}

void clean_up(self_pointer self, const std::string& instance) {
  std::error_code ignored;
  fs::remove_all(notify_dir(self, instance), ignored);
}

using removal_promise = caf::typed_response_promise<container_removed>;

void do_remove(self_pointer self, const remove_container& wish,
               removal_promise promise) {
  const auto target = target_of(wish.container, wish.instance);
  ask_engine(
      self, to_container("DELETE", target, "?force=true&v=true", force_limit),
      [=](const engine_answered& x) mutable {
        if (is_lost(x))
          self->state.unwanted.insert(wish.instance);
        // 409: somebody else is removing it. Without an id there may
        // never have been one, and if there was it goes when the engine
        // is back.
        const bool gone = is_good(x) || x.status == 404 || x.status == 409
                          || (is_lost(x) && wish.container.empty());
        if (gone) {
          forget(self, wish.instance);
          clean_up(self, wish.instance);
          promise.deliver(container_removed{});
        } else {
          promise.deliver(engine_failure("the container cannot be removed", x));
        }
      });
}

using adoption_promise = caf::typed_response_promise<container_adopted>;

void do_adopt(self_pointer self, const adopt_container& wish,
              adoption_promise promise);

void on_inspected(self_pointer self, const adopt_container& wish,
                  const engine_answered& x, adoption_promise promise) {
  const auto& instance = wish.instance;
  auto* container = find_container(self, instance);
  const auto found = object_of(x);
  const auto id = text_at(found, "Id");
  const auto state = object_at(found, "State");
  if (container != nullptr && is_running(found)) {
    if (auto error = open_words(self, instance, *container)) {
      promise.deliver(error);
      return forget(self, instance);
    }
    promise.deliver(container_adopted{true, id, -1});
    return settle(self, instance, id);
  }
  if (is_lost(x))
    self->state.waiting_adoptions.push_back(
        [=] { do_adopt(self, wish, promise); });
  else if (!is_good(x) && x.status != 404)
    promise.deliver(engine_failure("the container cannot be looked at", x));
  else if (text_at(state, "Status") == "created")
    // The node ended before it was started.
    promise.deliver(container_adopted{});
  else
    promise.deliver(container_adopted{false, id, exit_code_of(found)});
  forget(self, instance);
}

void do_adopt(self_pointer self, const adopt_container& wish,
              adoption_promise promise) {
  if (auto* known = find_container(self, wish.instance)) {
    if (known->settling)
      known->waiting.push_back([=] { do_adopt(self, wish, promise); });
    else
      promise.deliver(container_adopted{true, known->id, -1});
    return;
  }
  self->state.containers[wish.instance].settling = true;
  ask_engine(
      self,
      to_container("GET", target_of(wish.container, wish.instance), "/json"),
      [=](const engine_answered& x) { on_inspected(self, wish, x, promise); });
}

} // namespace

int exit_code_of(const json& container) {
  const auto code = number_at(object_at(container, "State"), "ExitCode", -1);
  return is_running(container) || code < 0 || code > 255
             ? -1
             : static_cast<int>(code);
}

bool is_running(const json& container) {
  return flag_at(object_at(container, "State"), "Running");
}

caf::result<container_started> start(self_pointer self,
                                     const start_container& wish) {
  if (!is_instance_id(wish.instance) || wish.command.empty())
    return bad_id(wish.instance);
  if (find_container(self, wish.instance) != nullptr)
    return runs_already(wish.instance);
  const auto files = files_of(wish);
  if (const auto* error = std::get_if<edge_error>(&files))
    return to_caf(*error);
  engine_container fresh;
  if (auto error = open_words(self, wish.instance, fresh))
    return error;
  fresh.settling = true;
  auto& st = self->state;
  st.unwanted.erase(wish.instance);
  st.containers[wish.instance] = std::move(fresh);
  auto attempt = std::make_shared<start_attempt>();
  attempt->wish = wish;
  attempt->promise = self->make_response_promise<container_started>();
  attempt->body = container_document(wish, std::get<container_files>(files),
                                     st.config.setting,
                                     notify_dir(self, wish.instance).string())
                      .dump(-1, ' ', false, json::error_handler_t::replace);
  create(self, attempt);
  return attempt->promise;
}

caf::result<container_stopped> stop(self_pointer self,
                                    const stop_container& wish) {
  if (!is_instance_id(wish.instance))
    return bad_id(wish.instance);
  auto promise = self->make_response_promise<container_stopped>();
  auto* x = find_container(self, wish.instance);
  if (x != nullptr && x->settling)
    x->waiting.push_back([=] { do_stop(self, wish, promise); });
  else
    do_stop(self, wish, promise);
  return promise;
}

caf::result<container_removed> remove(self_pointer self,
                                      const remove_container& wish) {
  if (!is_instance_id(wish.instance))
    return bad_id(wish.instance);
  auto promise = self->make_response_promise<container_removed>();
  auto* x = find_container(self, wish.instance);
  if (x != nullptr && x->settling)
    x->waiting.push_back([=] { do_remove(self, wish, promise); });
  else
    do_remove(self, wish, promise);
  return promise;
}

caf::result<container_adopted> adopt(self_pointer self,
                                     const adopt_container& wish) {
  if (!is_instance_id(wish.instance))
    return bad_id(wish.instance);
  auto promise = self->make_response_promise<container_adopted>();
  // An exit that nobody hears must not come between looking and listening.
  if (self->state.connected)
    do_adopt(self, wish, promise);
  else
    self->state.waiting_adoptions.push_back(
        [=] { do_adopt(self, wish, promise); });
  return promise;
}

void on_container_ended(self_pointer self, const std::string& instance,
                        const std::string& id, int exit_code) {
  auto& st = self->state;
  auto* x = find_container(self, instance);
  if (x == nullptr || (!x->id.empty() && x->id != id))
    return;
  if (x->settling) {
    x->early_exit = exit_code;
    return;
  }
  // What the program said last must not come after its end.
  const auto words = receive_notifications(x->notify_socket->get());
  if (words.ready || words.stopping || !words.status.empty())
    self->send(st.listener,
               instance_notified{instance, words.ready, words.alive,
                                 words.stopping, words.status});
  self->send(st.listener, container_exited{instance, id, exit_code});
  forget(self, instance);
}

void discard(self_pointer self, const std::string& instance) {
  ask_engine(
      self,
      to_container("DELETE", container_name(instance), "?force=true&v=true"),
      [=](const engine_answered& x) {
        if (is_lost(x))
          self->state.unwanted.insert(instance);
        else
          clean_up(self, instance);
      });
}

} // namespace roscell
