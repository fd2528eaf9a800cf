#include "actors/site/audit_log.hpp"

#include "actors/core/clocks.hpp"
#include "messages/event_kinds.hpp"

#include <utility>

namespace roscell {

namespace {

using audit_log_pointer = audit_log_actor::stateful_pointer<audit_log_state>;

void note(audit_log_pointer self, const note_change& x) {
  auto& st = self->state;
  audit_record record;
  record.unix_ms = unix_now_ms();
  record.from = x.from;
  record.request = x.request;
  record.subject = x.subject;
  record.outcome = x.outcome;
  const auto written = st.file->append(std::move(record));
  const auto* why = std::get_if<edge_error>(&written);
  if (why != nullptr && !st.broken)
    st.context.publish_event(
        events::edge_problem, "",
        {{"message", "a change is not in the audit log: " + why->message}});
  st.broken = why != nullptr;
}

} // namespace

audit_log_actor::behavior_type audit_log(audit_log_pointer self,
                                         const actor_context& context,
                                         const std::filesystem::path& folder) {
  self->state.context = context;
  self->state.file.emplace(folder);
  return {
      [self](const state_query&) {
        return state_of({{"broken", self->state.broken}});
      },
      [self](const audit_query& x) {
        return self->state.file->read(x.since, x.newest);
      },
      [self](const note_change& x) { note(self, x); },
  };
}

} // namespace roscell
