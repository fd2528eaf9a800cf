#include "actors/session/lease.hpp"

#include "actors/edge/session/limits.hpp"

#include <algorithm>

namespace roscell {

lease::lease(lease_side side, time_point now)
    : side_(side), heard_(now), next_(now + limits::lease::heartbeat_period),
      next_heartbeat_(now + limits::lease::heartbeat_period) {
  if (side == lease_side::coordinator)
    next_ += limits::lease::probe_interval;
}

void lease::heard(time_point now) {
  heard_ = now;
  unanswered_ = false;
}

std::optional<heartbeat_kind> lease::heard_heartbeat(heartbeat_kind kind,
                                                     time_point now) {
  heard(now);
  switch (kind) {
  case heartbeat_kind::heartbeat:
    return heartbeat_kind::ack;
  case heartbeat_kind::probe:
    return heartbeat_kind::heartbeat;
  case heartbeat_kind::ack:
    break;
  }
  return std::nullopt;
}

lease::step lease::due(time_point now) {
  if (now >= end())
    return {true, std::nullopt};
  auto result =
      side_ == lease_side::member ? member_due(now) : coordinator_due(now);
  next_ = std::min(next_, end());
  return result;
}

lease::step lease::member_due(time_point now) {
  if (!unanswered_ && now < next_heartbeat_) {
    next_ = next_heartbeat_;
    return {};
  }
  if (!unanswered_) {
    unanswered_ = true;
    next_heartbeat_ = now + limits::lease::heartbeat_period;
  }
  next_ = repeat_at(now);
  return {false, heartbeat_kind::heartbeat};
}

lease::step lease::coordinator_due(time_point now) {
  const auto missed_at =
      heard_ + limits::lease::heartbeat_period + limits::lease::probe_interval;
  if (now < missed_at) {
    next_ = missed_at;
    return {};
  }
  next_ = repeat_at(now);
  return {false, heartbeat_kind::probe};
}

lease::time_point lease::end() const {
  return heard_ + limits::lease::span;
}

lease::time_point lease::repeat_at(time_point now) const {
  const bool urgent = end() - now <= limits::lease::urgent_span;
  return now
         + (urgent ? limits::lease::urgent_probe_interval
                   : limits::lease::probe_interval);
}

std::string missed_heartbeats_text() {
  using seconds = std::chrono::seconds;
  constexpr auto span =
      std::chrono::duration_cast<seconds>(limits::lease::span);
  return "no heartbeat for " + std::to_string(span.count()) + " s";
}

} // namespace roscell
