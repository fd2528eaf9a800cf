#include "actors/session/session_exchange.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/session/limits.hpp"
#include "messages/allocation_report.hpp"
#include "messages/cell.hpp"
#include "messages/formation.hpp"
#include "messages/insight/request_trace.hpp"
#include "messages/instance.hpp"
#include "messages/parameter_change.hpp"
#include "messages/rebalance.hpp"
#include "messages/task.hpp"
#include "messages/task_set.hpp"
#include "messages/task_update.hpp"
#include "messages/topic.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace roscell {

session_answers::admission session_answers::admit(uint64_t id) {
  if (auto known = answers_.find(id); known != answers_.end()) {
    const auto& x = known->second;
    if (!x.done)
      return {verdict::busy, {}};
    if (x.text.empty())
      return {verdict::stale, {}};
    return {verdict::repeat, x.text};
  }
  if (id <= forgotten_)
    return {verdict::stale, {}};
  if (answers_.size() >= limits::session::known_calls && !drop_oldest_done())
    return {verdict::crowded, {}};
  answers_.emplace(id, answer{});
  return {verdict::fresh, {}};
}

void session_answers::record(uint64_t id, const std::string& text) {
  auto known = answers_.find(id);
  if (known == answers_.end())
    return;
  known->second.done = true;
  if (text.size() <= limits::session::kept_answer_bytes)
    known->second.text = text;
}

bool session_answers::drop_oldest_done() {
  auto oldest = std::find_if(answers_.begin(), answers_.end(),
                             [](const auto& x) { return x.second.done; });
  if (oldest == answers_.end())
    return false;
  forgotten_ = std::max(forgotten_, oldest->first);
  answers_.erase(oldest);
  return true;
}

namespace {

std::string reply_text(uint64_t id, const json& body) {
  return write_envelope(envelope_kind::reply, id, body);
}

json refusal(error_code code, std::string message) {
  return error_reply({code, std::move(message), "", "", ""});
}

} // namespace

session_exchange::session_exchange(send_function send)
    : send_(std::move(send)) {}

void session_exchange::call(const json& body, time_point deadline,
                            session_calls::on_result done) {
  if (auto text = calls_.begin(body, deadline, std::move(done)))
    send_(std::move(*text));
}

bool session_exchange::notify(const json& body) {
  auto text = write_envelope(envelope_kind::notice, 0, body);
  if (text.size() > limits::session::frame_bytes)
    return false;
  send_(std::move(text));
  return true;
}

std::optional<session_inquiry>
session_exchange::receive(const std::string& frame) {
  auto envelope = read_envelope(frame);
  if (!envelope) {
    ++bad_frames_;
    return std::nullopt;
  }
  if (envelope->refused)
    ++bad_frames_;
  switch (envelope->kind) {
  case envelope_kind::reply:
    // One that nobody waits for comes late or again: no harm, no use.
    calls_.finish(*envelope);
    return std::nullopt;
  case envelope_kind::request:
    return admit(std::move(*envelope));
  case envelope_kind::notice:
    break;
  }
  if (envelope->refused)
    return std::nullopt;
  return session_inquiry{std::nullopt, std::move(envelope->body)};
}

void session_exchange::answer(uint64_t id, const json& body) {
  auto text = reply_text(id, body);
  if (text.size() > limits::session::frame_bytes)
    text = reply_text(id, refusal(error_code::conflict,
                                  "the answer is too large for a session"));
  answers_.record(id, text);
  send_(std::move(text));
}

std::optional<session_inquiry> session_exchange::admit(session_envelope frame) {
  using verdict = session_answers::verdict;
  if (frame.refused) {
    send_(reply_text(frame.id, error_reply(*frame.refused)));
    return std::nullopt;
  }
  auto admission = answers_.admit(frame.id);
  switch (admission.what) {
  case verdict::fresh:
    return session_inquiry{frame.id, std::move(frame.body)};
  case verdict::busy:
    break;
  case verdict::repeat:
    send_(std::move(admission.text));
    break;
  case verdict::stale:
    send_(reply_text(frame.id, refusal(error_code::conflict,
                                       "this request has been answered")));
    break;
  case verdict::crowded:
    send_(reply_text(
        frame.id, refusal(error_code::conflict, "too many requests at once")));
    break;
  }
  return std::nullopt;
}

namespace {

/// What the coordinator answers from what it knows.
constexpr std::array<std::string_view, 11> queries{
    fresh_cell_query::type,    cell_query::type,
    cell_list_query::type,     task_query::type,
    task_history_query::type,  task_placement_query::type,
    request_trace_query::type, transfer_query::type,
    topic_query::type,         instance_query::type,
    task_revisions_query::type};

/// What it has to do something for.
constexpr std::array<std::string_view, 13> commands{
    task_request::type,    task_plan_query::type, task_termination::type,
    task_restart::type,    node_drain::type,      node_undrain::type,
    cell_rebalance::type,  skill_addition::type,  skill_removal::type,
    skill_pull::type,      task_update::type,     task_set_request::type,
    parameter_change::type};

/// That whoever waits for the member's answer waits longer than the member.
constexpr std::chrono::seconds log_margin{2};
static_assert(limits::log::wait + limits::log::answer
              < limits::log::stream - log_margin);

template <class Names>
bool holds(const Names& names, const std::string& type) {
  for (const auto& x : names)
    if (x == type)
      return true;
  return false;
}

} // namespace

std::optional<forwarding_limits> forwarding_of(const std::string& type) {
  if (holds(queries, type))
    return forwarding_limits{limits::request::forwarded_query,
                             limits::request::member_query};
  // It may be waited for, by whoever follows a log.
  if (type == log_query::type)
    return forwarding_limits{limits::log::wait + limits::log::answer,
                             limits::log::stream - log_margin};
  if (type == task_change_query::type)
    return forwarding_limits{
        limits::task::change_wait + limits::request::forwarded_query,
        limits::task::change_wait + limits::request::member_query};
  if (holds(commands, type))
    return forwarding_limits{limits::request::forwarded,
                             limits::request::member_request};
  if (const auto node = relayed_limit(type))
    return forwarding_limits{*node + 2 * relay_margin,
                             *node + 3 * relay_margin};
  return std::nullopt;
}

} // namespace roscell
