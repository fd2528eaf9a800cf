#include "actors/node/event_loudness.hpp"

#include "messages/codec/json_codec.hpp"
#include "messages/event_kinds.hpp"

#include <string_view>

namespace roscell {

namespace {

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size()
         && text.substr(text.size() - end.size()) == end;
}

bool is_failure_event(const event& e) {
  const auto data = json::parse(e.data, nullptr, false);
  return data.is_object() && data.value("state", json{}) == "failed";
}

} // namespace

loudness loudness_of(const event& e) {
  for (const auto* end : {"_lost", "_failed", "_refused", "_ignored"})
    if (ends_with(e.what, end))
      return loudness::warning;
  if (e.what != events::instance_changed)
    return loudness::info;
  return is_failure_event(e) ? loudness::warning : loudness::debug;
}

} // namespace roscell
