#include "actors/edge/engine/engine_text.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/instances/engine/engine_containers.hpp"
#include "actors/instances/engine/engine_parts.hpp"
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

} // namespace roscell
