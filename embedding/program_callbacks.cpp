#include "embedding/program_callbacks.hpp"

#include "actors/core/shifted_times.hpp"
#include "actors/core/watching.hpp"
#include "actors/node/event_series.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/event_kinds.hpp"
#include "messages/messages.hpp"

#include <optional>
#include <string>

namespace roscell::embedding {

namespace {

json particulars_of(const event& e) {
  auto data = json::parse(e.data, nullptr, false);
  return data.is_object() ? data : json::object();
}

log_level level_of(const event& e) {
  switch (loudness_of(e)) {
  case loudness::debug:
    return log_level::debug;
  case loudness::warning:
    return log_level::warning;
  case loudness::info:
    break;
  }
  return log_level::info;
}

/// What is not told of joining is no problem of it; nothing for an event that
/// says nothing about it.
std::optional<join_problem> problem_in(const event& e) {
  if (e.what == events::cell_joined)
    return join_problem{};
  if (e.what != events::join_failed && e.what != events::join_refused)
    return std::nullopt;
  const auto data = particulars_of(e);
  return join_problem{data.value("discovery_server", ""),
                      data.value("reason", ""), data.value("hint", "")};
}

void notify_program(const node_callbacks& calls, const event& e) {
  if (calls.on_event)
    calls.on_event({e.sequence, to_wall_clock()(e.time_unix_ms), e.what,
                    e.subject, e.data});
  if (calls.on_log && !e.passing)
    calls.on_log(level_of(e), log_line(e));
  if (calls.on_join_problem)
    if (const auto problem = problem_in(e))
      calls.on_join_problem(*problem);
}

} // namespace

std::string log_line(const event& e) {
  auto result = e.what + " '" + e.subject + "'";
  const auto data = particulars_of(e);
  for (const auto& [key, value] : data.items())
    result +=
        " " + key + "="
        + (value.is_string()
               ? value.get<std::string>()
               : value.dump(-1, ' ', false, json::error_handler_t::replace));
  return result;
}

bool wants_to_hear(const node_callbacks& calls) {
  return calls.on_event || calls.on_log || calls.on_join_problem;
}

event_listener_actor::behavior_type program_callbacks(
    event_listener_actor::stateful_pointer<program_callbacks_state> self,
    const event_log_actor& events,
    const std::shared_ptr<const node_callbacks>& calls) {
  watch_until_own_end(self, events);
  self->set_down_handler([self](const caf::down_msg&) { self->quit(); });
  return {
      [calls](const event& e) {
        try {
          notify_program(*calls, e);
        } catch (...) {
          // It is the program's own, which must not end the node's telling.
        }
      },
  };
}

} // namespace roscell::embedding
