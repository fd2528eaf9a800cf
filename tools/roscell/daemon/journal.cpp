#include "tools/roscell/daemon/journal.hpp"

#include "actors/core/watching.hpp"
#include "actors/node/event_series.hpp"
#include "messages/event_kinds.hpp"
#include "messages/messages.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <caf/send.hpp>
#include <caf/typed_event_based_actor.hpp>

#include <spdlog/spdlog.h>

namespace roscell::cli {

namespace {

std::string quoted(const std::string& name) {
  return "'" + name + "'";
}

std::string hint_of(const event& e) {
  const auto hint = event_text(e, "hint");
  return hint.empty() ? hint : " (" + hint + ")";
}

void print(const event& e) {
  static constexpr spdlog::level::level_enum levels[] = {
      spdlog::level::debug, spdlog::level::info, spdlog::level::warn};
  spdlog::log(levels[static_cast<size_t>(loudness_of(e))], "{}",
              journal_line(e));
}

event_listener_actor::behavior_type journal(event_listener_actor::pointer self,
                                            const event_log_actor& events) {
  watch_until_own_end(self, events);
  self->set_down_handler([self](const caf::down_msg&) { self->quit(); });
  // A program that crashes again and again would fill the system's log.
  return {[](const event& e) {
    if (!e.passing)
      print(e);
  }};
}

} // namespace

void start_journal(caf::actor_system& system, const event_log_actor& events) {
  const auto listener = system.spawn(journal, events);
  caf::anon_send(events, subscribe_events{listener, 0});
}

std::string journal_line(const event& e) {
  const auto text = [&](const char* key) { return event_text(e, key); };
  std::string line;
  if (e.what == events::cell_joined)
    line = "joined cell " + quoted(text("cell")) + " of "
           + quoted(text("coordinator"));
  else if (e.what == events::cell_left)
    line = "left cell " + quoted(text("cell"));
  else if (e.what == events::coordinator_lost)
    line = "lost cell " + quoted(text("cell")) + ": " + text("reason");
  else if (e.what == events::join_refused)
    line = "cannot join at " + text("discovery_server") + ": " + text("reason")
           + hint_of(e);
  else if (e.what == events::join_failed)
    line = (text("discovery_server").empty()
                ? "in no cell yet: "
                : "not joined yet at " + text("discovery_server") + ": ")
           + text("reason") + hint_of(e);
  else
    line = e.what + " " + quoted(e.subject) + " " + event_particulars(e);
  line = printable(line);
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

} // namespace roscell::cli
