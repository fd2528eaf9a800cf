#include "actors/requests/request_history.hpp"

#include "messages/codec/json_codec.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

int64_t span_us(request_history::time_point from,
                request_history::time_point to) {
  using namespace std::chrono;
  return duration_cast<microseconds>(to - from).count();
}

size_t size_of(const task_placement& x) {
  return x.task.size() + x.plan.size() + x.refusal.size();
}

} // namespace

request_history::ticket request_history::begin(std::string type,
                                               std::string subject,
                                               int64_t unix_ms,
                                               time_point now) {
  std::lock_guard guard{mutex_};
  while (entries_.size() == max_requests
         || (!entries_.empty() && parts_ > max_parts))
    drop_oldest_request();
  auto& x = entries_.emplace_back();
  x.id = ++last_;
  x.came = now;
  x.trace.request = std::move(type);
  x.trace.subject = std::move(subject);
  x.trace.came_unix_ms = unix_ms;
  return x.id;
}

void request_history::enter(ticket request, std::string handler,
                            time_point now) {
  std::lock_guard guard{mutex_};
  auto* x = find(request);
  if (x == nullptr || x->trace.hops.size() == max_hops)
    return;
  close_hop(*x, now);
  auto& hop = x->trace.hops.emplace_back();
  hop.handler = std::move(handler);
  hop.begin_us = span_us(x->came, now);
  x->actors.emplace_back();
  ++parts_;
}

request_history::question request_history::ask(ticket request, uint64_t actor,
                                               std::string node,
                                               time_point now) {
  std::lock_guard guard{mutex_};
  auto* x = find(request);
  if (x == nullptr || x->trace.hops.empty())
    return {};
  auto& hop = x->trace.hops.back();
  if (hop.asked.size() == max_questions) {
    ++hop.dropped;
    return {};
  }
  auto& asked = hop.asked.emplace_back();
  asked.node = std::move(node);
  asked.begin_us = span_us(x->came, now);
  x->actors.back().push_back(actor);
  ++parts_;
  return {request, x->trace.hops.size() - 1, hop.asked.size() - 1};
}

void request_history::answer(const question& asked, bool refused,
                             time_point now) {
  std::lock_guard guard{mutex_};
  auto* x = find(asked.request);
  if (x == nullptr)
    return;
  auto& question = x->trace.hops[asked.hop].asked[asked.index];
  question.span_us = span_us(x->came, now) - question.begin_us;
  question.refused = refused;
}

void request_history::end(ticket request, std::string refusal, time_point now) {
  std::lock_guard guard{mutex_};
  auto* x = find(request);
  if (x == nullptr)
    return;
  close_hop(*x, now);
  x->trace.span_us = span_us(x->came, now);
  x->trace.refusal = std::move(refusal);
}

std::vector<request_trace>
request_history::traces(const std::string& subject,
                        const name_function& name_of) const {
  std::vector<request_trace> result;
  std::lock_guard guard{mutex_};
  for (const auto& x : entries_) {
    if (!subject.empty() && x.trace.subject != subject)
      continue;
    auto& trace = result.emplace_back(x.trace);
    for (size_t i = 0; i < trace.hops.size(); ++i)
      for (size_t j = 0; j < trace.hops[i].asked.size(); ++j)
        trace.hops[i].asked[j].actor = name_of(x.actors[i][j]);
  }
  return result;
}

void request_history::decide(task_placement placement) {
  shorten_decision(placement.plan, max_decision_bytes);
  shorten_decision(placement.refusal, max_decision_bytes);
  std::lock_guard guard{mutex_};
  const auto known =
      std::find_if(placements_.begin(), placements_.end(),
                   [&](const auto& x) { return x.task == placement.task; });
  if (known != placements_.end()) {
    placement_bytes_ -= size_of(*known);
    placements_.erase(known);
  }
  placement_bytes_ += size_of(placement);
  placements_.push_back(std::move(placement));
  trim_placements();
}

std::optional<task_placement>
request_history::placement(const std::string& task) const {
  std::lock_guard guard{mutex_};
  for (const auto& x : placements_)
    if (x.task == task)
      return x;
  return std::nullopt;
}

void request_history::drop_oldest_request() {
  parts_ -= entries_.front().actors.size();
  for (const auto& asked : entries_.front().actors)
    parts_ -= asked.size();
  entries_.pop_front();
}

request_history::entry* request_history::find(ticket id) {
  for (auto& x : entries_)
    if (x.id == id)
      return &x;
  return nullptr;
}

void request_history::close_hop(entry& of, time_point now) {
  auto& hops = of.trace.hops;
  if (!hops.empty() && hops.back().span_us < 0)
    hops.back().span_us = span_us(of.came, now) - hops.back().begin_us;
}

void request_history::trim_placements() {
  while (placements_.size() > max_placements
         || placement_bytes_ > max_placement_bytes) {
    placement_bytes_ -= size_of(placements_.front());
    placements_.pop_front();
  }
}

namespace {

/// How many of the first of these have room.
size_t fitting(const json& list, size_t most_bytes) {
  size_t bytes = 0;
  for (size_t i = 0; i < list.size(); ++i) {
    bytes += list[i].dump().size() + 1;
    if (bytes > most_bytes)
      return i;
  }
  return list.size();
}

} // namespace

void shorten_decision(std::string& text, size_t most_bytes) {
  if (text.size() <= most_bytes)
    return;
  auto document = json::parse(text, nullptr, false);
  const bool refused = document.is_object() && document.contains("error");
  auto& explained = refused ? document["error"] : document;
  if (!explained.is_object() || !explained.contains("rejected"))
    return;
  auto& rejected = explained["rejected"];
  const auto all = rejected.size();
  const auto excess = text.size() - most_bytes;
  const auto size = rejected.dump().size();
  const auto kept = fitting(rejected, size > excess ? size - excess : 0);
  rejected.erase(rejected.begin() + static_cast<json::difference_type>(kept),
                 rejected.end());
  const auto words = "of " + std::to_string(all) + " rejected candidates, "
                     + std::to_string(kept) + " are kept";
  if (refused)
    explained["message"] = explained.value("message", "") + "; " + words;
  else
    explained["warnings"].push_back(words);
  text = document.dump();
}

} // namespace roscell
