#include "actors/core/actor_context.hpp"

#include "messages/messages.hpp"

#include <caf/sec.hpp>
#include <caf/system_messages.hpp>

namespace roscell {

namespace {

/// A path of the host or a word of a library need not be UTF-8.
constexpr auto replace_bad_bytes = json::error_handler_t::replace;

} // namespace

void actor_context::publish_event(const event_kind& what, std::string subject,
                                  const json& data) const {
  if (events)
    caf::anon_send(events,
                   record_event{std::string{what.name}, std::move(subject),
                                data.is_null() ? std::string{}
                                               : data.dump(-1, ' ', false,
                                                           replace_bad_bytes)});
}

void actor_context::count(metric which, metric_table::label_values labels,
                          double amount) const {
  if (metrics)
    metrics->add(which, labels, amount);
}

void actor_context::observe(metric which, metric_table::label_values labels,
                            double value) const {
  if (metrics)
    metrics->observe(which, labels, value);
}

caf::mailbox_element_ptr with_alarm_as_tick(caf::mailbox_element_ptr what) {
  const auto& content = what->content();
  if (!content.match_elements<caf::timeout_msg>())
    return what;
  const auto& timeout = content.get_as<caf::timeout_msg>(0);
  if (timeout.type != alarm_timeout)
    return what;
  return caf::make_mailbox_element(what->sender, what->mid, {},
                                   caf::tick_atom_v, timeout.timeout_id);
}

caf::error end_by_exception(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const std::exception& what) {
    return caf::make_error(caf::sec::runtime_error, std::string{what.what()});
  } catch (...) {
    return caf::sec::runtime_error;
  }
}

} // namespace roscell
