#include "client/event_follower.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

/// An event is far smaller; more than this is a peer gone wrong.
constexpr size_t max_data_bytes = 4UL * 1024 * 1024;

std::optional<event> decode(const std::string& text) {
  const auto document = json::parse(text, nullptr, false);
  if (!document.is_object())
    return std::nullopt;
  try {
    return document.get<event>();
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

} // namespace

std::optional<event> event_stream::add_line(std::string_view line) {
  if (!line.empty() && line.back() == '\r')
    line.remove_suffix(1);
  if (line.empty()) {
    auto complete = decode(data_);
    data_.clear();
    return complete;
  }
  constexpr std::string_view field = "data:";
  if (line.substr(0, field.size()) != field)
    return std::nullopt;
  line.remove_prefix(field.size());
  if (!line.empty() && line.front() == ' ')
    line.remove_prefix(1);
  if (data_.size() + line.size() < max_data_bytes)
    data_.append(line).append("\n");
  return std::nullopt;
}

namespace {

constexpr std::chrono::milliseconds first_pause{250};
constexpr std::chrono::milliseconds longest_pause{5000};

} // namespace

event_follower::event_follower(line_reader read, hooks calls, uint64_t since)
    : read_{std::move(read)}, calls_{std::move(calls)}, last_{since},
      pause_{first_pause}, thread_{[this] { run(); }} {}

event_follower::~event_follower() {
  {
    const std::lock_guard guard{mutex_};
    ended_ = true;
  }
  wakes_.notify_one();
  cancel_.cancel();
  thread_.join();
}

void event_follower::look_now() {
  const std::lock_guard guard{mutex_};
  hurries_ = true;
  wakes_.notify_one();
}

void event_follower::run() {
  do {
    std::exception_ptr why;
    try {
      follow_once();
    } catch (...) {
      why = std::current_exception();
    }
    {
      const std::lock_guard guard{mutex_};
      if (ended_)
        return;
      // What hurried before has been done.
      hurries_ = false;
    }
    if (!calls_.on_end(why))
      return;
  } while (pause());
}

std::vector<event> event_follower::kept_events() {
  std::vector<event> result;
  if (last_ == from_now_on)
    return result;
  event_stream lines;
  read_(
      "/v1/events?follow=0&since=" + std::to_string(last_),
      [&](std::string_view x) {
        if (auto complete = lines.add_line(x))
          result.push_back(std::move(*complete));
        return true;
      },
      cancel_);
  return result;
}

void event_follower::follow_once() {
  auto kept = kept_events();
  for (const auto& x : kept)
    last_ = x.sequence;
  event_stream lines;
  bool open = false;
  read_(
      "/v1/events?since=" + std::to_string(last_),
      [&](std::string_view x) {
        // The first line, a comment, says that nothing is missed any more.
        if (!std::exchange(open, true)) {
          pause_ = first_pause;
          calls_.on_open(std::exchange(kept, {}));
        }
        if (auto complete = lines.add_line(x)) {
          last_ = complete->sequence;
          calls_.on_event(std::move(*complete));
        }
        return true;
      },
      cancel_);
}

bool event_follower::pause() {
  std::unique_lock guard{mutex_};
  wakes_.wait_for(guard, pause_, [this] { return ended_ || hurries_; });
  hurries_ = false;
  pause_ = std::min(longest_pause, pause_ * 2);
  return !ended_;
}

} // namespace roscell
