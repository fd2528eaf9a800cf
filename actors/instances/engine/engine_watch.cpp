#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "actors/instances/engine/engine_parts.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

/// To connect in vain to a socket of this host costs some microseconds.
constexpr backoff::duration longest_pause{2'000};

/// The filter of this node's containers, for a query.
std::string filter(const engine_runtime_state& st, json more) {
  more["label"] = json::array({"roscell.node=" + st.config.setting.node_uuid});
  return "filters=" + percent_encode(more.dump());
}

void problem(engine_runtime_pointer self, const std::string& why) {
  auto& st = self->state;
  if (std::exchange(st.problem, why) == why)
    return;
  st.config.context.publish_event(why.empty() ? events::engine_found
                                              : events::engine_lost,
                                  st.config.socket, {{"message", why}});
  self->send(st.listener, runtime_problem_changed{why});
}

void on_events_ended(engine_runtime_pointer self, const engine_answered& x) {
  auto& st = self->state;
  st.connected = false;
  st.events = {};
  problem(self,
          is_lost(x) ? x.why.message
          : is_good(x)
              ? "the container engine on '" + st.config.socket + "' has ended"
              : engine_refusal("the container engine gives no events",
                               {x.status, x.body})
                    .message);
  st.next_attempt =
      self->clock().now() + std::min(st.pause.next(), longest_pause);
  st.timer.set(self, *st.next_attempt);
}

/// The exit of a container that ended while nobody listened.
void learn_exit(engine_runtime_pointer self, const std::string& instance,
                const std::string& id) {
  engine_request request;
  request.target = "/containers/" + id + "/json";
  ask_engine(self, std::move(request), [=](const engine_answered& x) {
    if (!is_lost(x) && !is_running(object_of(x)))
      on_container_ended(self, instance, id, exit_code_of(object_of(x)));
  });
}

using container_ids = std::map<std::string, std::string>;

/// The containers that run as far as is known, by instance.
container_ids running_containers(const engine_runtime_state& st) {
  container_ids result;
  for (const auto& [instance, container] : st.containers)
    if (!container.settling)
      result.emplace(instance, container.id);
  return result;
}

/// Compares what the engine has with what it should have had when it was
/// asked.
void reconcile(engine_runtime_pointer self, const container_ids& expected,
               const engine_answered& x) {
  auto& st = self->state;
  const auto list = json::parse(x.body, nullptr, false);
  if (!is_good(x) || !list.is_array())
    return; // The stream will end too.
  std::set<std::string> running;
  for (const auto& row : list)
    if (row.is_object() && text_at(row, "State") == "running")
      running.insert(text_at(row, "Id"));
  for (const auto& [instance, id] : expected)
    if (running.count(id) == 0)
      learn_exit(self, instance, id);
  for (const auto& instance : std::exchange(st.unwanted, {}))
    discard(self, instance);
}

void on_events_opened(engine_runtime_pointer self) {
  auto& st = self->state;
  st.connected = true;
  st.pause.reset();
  engine_request request;
  request.target = "/containers/json?all=true&" + filter(st, json::object());
  ask_engine(self, std::move(request),
             [self, expected = running_containers(st)](
                 const engine_answered& x) { reconcile(self, expected, x); });
  problem(self, {});
  for (const auto& adoption : std::exchange(st.waiting_adoptions, {}))
    adoption();
}

} // namespace

void watch_events(engine_runtime_pointer self) {
  auto& st = self->state;
  st.next_attempt.reset();
  engine_request request;
  // Podman 4.3 says "die" as Docker does, but filters by its own word.
  request.target = "/events?"
                   + filter(st, {{"type", json::array({"container"})},
                                 {"event", json::array({"die", "died"})}});
  request.endless = true;
  auto opened =
      stream_lines(self, std::move(request), [self](const engine_answered& x) {
        on_events_ended(self, x);
      });
  st.events_call = opened.call;
  st.events = std::move(opened.stream);
}

void on_event_lines(engine_runtime_pointer self,
                    const std::vector<std::string>& lines) {
  if (lines.empty())
    return on_events_opened(self);
  for (const auto& line : lines) {
    const auto event = json::parse(line, nullptr, false);
    if (!event.is_object() || text_at(event, "Action") != "die")
      continue;
    const auto who = object_at(event, "Actor");
    const auto attributes = object_at(who, "Attributes");
    // Docker says exitCode, Podman containerExitCode.
    auto code = text_at(attributes, "exitCode");
    if (code.empty())
      code = text_at(attributes, "containerExitCode");
    const auto instance = text_at(attributes, "roscell.instance");
    const auto known = code.size() < 4 && !code.empty()
                       && code.find_first_not_of("0123456789") == code.npos;
    on_container_ended(self, instance, text_at(who, "ID"),
                       known ? std::stoi(code) : -1);
  }
}

namespace {

using adoption_promise = caf::typed_response_promise<container_adopted>;

void do_adopt(engine_runtime_pointer self, const adopt_container& request,
              adoption_promise promise);
void inspect(engine_runtime_pointer self, const adopt_container& request,
             adoption_promise promise);

/// Its shim is asked first: an engine that ended with its host knows less.
container_adopted ended_container(engine_runtime_pointer self,
                                  const std::string& instance,
                                  const json& found) {
  const auto end = read_exit_record(notify_dir(self, instance));
  container_adopted result{false, text_at(found, "Id"),
                           end ? end->exit_code : exit_code_of(found),
                           end.has_value(), end && end->terminated};
  result.cause = cause_of(found, end, result.exit_code);
  if (end)
    result.most_memory_mib = end->most_memory_mib;
  return result;
}

void on_inspected(engine_runtime_pointer self, const adopt_container& request,
                  const engine_answered& x, adoption_promise promise) {
  const auto& instance = request.instance;
  auto* container = find_container(self, instance);
  const auto found = object_of(x);
  const auto id = text_at(found, "Id");
  const auto state = object_at(found, "State");
  // A node that was killed may know no more than the container of an earlier
  // run; its successor has the instance's name.
  if (!request.container.empty() && !is_lost(x) && !is_running(found))
    return inspect(self, {instance, {}}, promise);
  if (container != nullptr && is_running(found)) {
    if (auto error = open_status(self, instance, *container)) {
      promise.deliver(error);
      return forget(self, instance);
    }
    promise.deliver(container_adopted{true, id, -1});
    return settle(self, instance, id);
  }
  if (is_lost(x))
    self->state.waiting_adoptions.push_back(
        [=] { do_adopt(self, request, promise); });
  else if (!is_good(x) && x.status != 404)
    promise.deliver(engine_failure("the container cannot be looked at", x));
  else if (text_at(state, "Status") == "created")
    // The node ended before it was started.
    promise.deliver(container_adopted{});
  else
    promise.deliver(ended_container(self, instance, found));
  forget(self, instance);
}

void do_adopt(engine_runtime_pointer self, const adopt_container& request,
              adoption_promise promise) {
  if (auto* known = find_container(self, request.instance)) {
    if (known->settling)
      known->waiting.push_back([=] { do_adopt(self, request, promise); });
    else
      promise.deliver(container_adopted{true, known->id, -1});
    return;
  }
  self->state.containers[request.instance].settling = true;
  inspect(self, request, promise);
}

void inspect(engine_runtime_pointer self, const adopt_container& request,
             adoption_promise promise) {
  ask_engine(self,
             to_container("GET", target_of(request.container, request.instance),
                          "/json"),
             [=](const engine_answered& x) {
               on_inspected(self, request, x, promise);
             });
}

} // namespace

caf::result<container_adopted> adopt(engine_runtime_pointer self,
                                     const adopt_container& request) {
  if (!is_instance_id(request.instance))
    return bad_id(request.instance);
  auto promise = self->make_response_promise<container_adopted>();
  // An exit that nobody hears must not come between looking and listening.
  if (self->state.connected)
    do_adopt(self, request, promise);
  else
    self->state.waiting_adoptions.push_back(
        [=] { do_adopt(self, request, promise); });
  return promise;
}

} // namespace roscell
