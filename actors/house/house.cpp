#include "actors/house/house.hpp"

#include "messages/messages.hpp"

namespace roscell {

namespace {

/// A path of the host or a word of a library need not be UTF-8.
constexpr auto replace_bad_bytes = json::error_handler_t::replace;

} // namespace

void house::tell(std::string what, std::string subject,
                 const json& data) const {
  if (events)
    caf::anon_send(events,
                   record_event{std::move(what), std::move(subject),
                                data.is_null() ? std::string{}
                                               : data.dump(-1, ' ', false,
                                                           replace_bad_bytes)});
}

void house::count(metric which, metric_book::label_values labels,
                  double amount) const {
  if (metrics)
    metrics->add(which, labels, amount);
}

void house::observe(metric which, metric_book::label_values labels,
                    double value) const {
  if (metrics)
    metrics->observe(which, labels, value);
}

} // namespace roscell
