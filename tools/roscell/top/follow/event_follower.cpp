#include "tools/roscell/top/follow/event_follower.hpp"

#include "client/event_stream.hpp"

#include <algorithm>

namespace roscell::cli::top {

namespace {

constexpr std::chrono::milliseconds first_pause{250};
constexpr std::chrono::milliseconds longest_pause{5000};

} // namespace

event_follower::event_follower(const http_endpoint& node, mailbox& to)
    : node_{node}, to_{to}, next_pause_{first_pause}, reader_{
                                                          [this] { run(); }} {}

event_follower::~event_follower() {
  {
    const std::lock_guard guard{mutex_};
    ended_ = true;
  }
  ends_.notify_one();
  node_.cancel();
  reader_.join();
}

void event_follower::run() {
  do {
    try {
      follow_once();
    } catch (const std::exception& e) {
      to_.put(events_lost{reason_in(e)});
    }
  } while (pause());
}

std::vector<event> event_follower::kept_events() const {
  std::vector<event> result;
  event_stream lines;
  node_.follow("/v1/events?follow=0&since=0", [&](std::string_view x) {
    if (auto complete = lines.add_line(x))
      result.push_back(std::move(*complete));
    return true;
  });
  return result;
}

void event_follower::follow_once() {
  auto kept = kept_events();
  // From there on nothing is missed, and nothing is told twice.
  const auto last = kept.empty() ? 0 : kept.back().sequence;
  to_.put(events_opened{std::move(kept)});
  next_pause_ = first_pause;
  event_stream lines;
  node_.follow("/v1/events?since=" + std::to_string(last),
               [&](std::string_view x) {
                 if (auto complete = lines.add_line(x))
                   to_.put(std::move(*complete));
                 return true;
               });
  throw no_answer{"the node has ended the stream of events"};
}

bool event_follower::pause() {
  std::unique_lock guard{mutex_};
  ends_.wait_for(guard, next_pause_, [this] { return ended_; });
  next_pause_ = std::min(longest_pause, next_pause_ * 2);
  return !ended_;
}

} // namespace roscell::cli::top
