#include "actors/instances/life/health_table.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

namespace roscell {

namespace {

using std::chrono::duration;
using std::chrono::steady_clock;

bool has_bounds(const stream_bounds& x) {
  return x.min_rate_hz > 0 || x.max_age_s > 0;
}

/// "2.13", "0.04", "12000"
std::string number(double value) {
  char text[64];
  const bool is_small = value < 1000;
  const auto end = std::to_chars(std::begin(text), std::end(text), value,
                                 is_small ? std::chars_format::general
                                          : std::chars_format::fixed,
                                 is_small ? 3 : 0)
                       .ptr;
  return {std::begin(text), end};
}

const stream_metrics* find_stream(const std::vector<stream_metrics>& reported,
                                  const std::string& end) {
  const auto i = std::find_if(reported.begin(), reported.end(),
                              [&](const auto& x) { return x.end == end; });
  return i == reported.end() ? nullptr : &*i;
}

std::string end_name(const char* direction, size_t number) {
  return direction + (":" + std::to_string(number));
}

} // namespace

bool has_bounds(const health_policy& policy) {
  return has_bounds(policy.inputs) || has_bounds(policy.outputs);
}

health_table::health_table(const instance_spec& spec, time_point ready_since,
                           std::vector<std::string> upstream_steps,
                           health_verdict before)
    : grace_(std::chrono::duration_cast<steady_clock::duration>(
        duration<double>{spec.life.health.grace_s})),
      ready_since_(ready_since), last_(std::move(before)) {
  const auto& policy = spec.life.health;
  upstream_steps.resize(spec.input.size());
  for (size_t i = 0; has_bounds(policy.inputs) && i < spec.input.size(); ++i)
    streams_.push_back({end_name("input", i),
                        "input '" + spec.input[i].endpoint + "'", policy.inputs,
                        std::move(upstream_steps[i]), true, std::nullopt});
  for (size_t i = 0; has_bounds(policy.outputs) && i < spec.output.size(); ++i)
    streams_.push_back({end_name("output", i),
                        "output '" + spec.output[i].endpoint + "'",
                        policy.outputs, std::string{}, false, std::nullopt});
}

double health_table::age_of(const stream_metrics& measured,
                            time_point now) const {
  return measured.age_s >= 0 ? measured.age_s
                             : duration<double>{now - ready_since_}.count();
}

bool health_table::breaks(const stream& x, const stream_metrics& measured,
                          time_point now) const {
  return measured.rate_hz < x.bounds.min_rate_hz
         || (x.bounds.max_age_s > 0
             && age_of(measured, now) > x.bounds.max_age_s);
}

void health_table::update(const std::vector<stream_metrics>& reported,
                          time_point now) {
  const bool was_silent =
      heard_ && now - *heard_ > grace_ + silence_beyond_grace;
  heard_ = now;
  for (auto& x : streams_) {
    const auto* measured = find_stream(reported, x.end);
    if (measured == nullptr || !breaks(x, *measured, now))
      x.broken_since.reset();
    else if (!x.broken_since || was_silent)
      x.broken_since = now;
  }
  if (!any_input_is_broken())
    return;
  for (auto& x : streams_)
    if (!x.is_input && x.broken_since)
      x.broken_since = now;
}

bool health_table::any_input_is_broken() const {
  return std::any_of(streams_.begin(), streams_.end(), [](const stream& x) {
    return x.is_input && x.broken_since;
  });
}

const health_table::stream* health_table::first_breach(time_point now) const {
  const auto i =
      std::find_if(streams_.begin(), streams_.end(), [&](const stream& x) {
        return x.broken_since && now - *x.broken_since > grace_;
      });
  return i == streams_.end() ? nullptr : &*i;
}

std::string health_table::sentence_on(const stream& x,
                                      const stream_metrics& measured,
                                      time_point now) const {
  std::string result = x.name;
  const auto age_s = age_of(measured, now);
  const bool is_old = x.bounds.max_age_s > 0 && age_s > x.bounds.max_age_s;
  if (is_old)
    result += " has had no frame for more than " + number(age_s)
              + " s, at most " + number(x.bounds.max_age_s) + " s are wanted";
  else
    result += std::string{x.is_input ? " comes" : " goes"} + " at "
              + number(measured.rate_hz) + " Hz, at least "
              + number(x.bounds.min_rate_hz) + " Hz are wanted";
  return x.upstream_step.empty() ? result : result + "; " + x.upstream_step;
}

bool health_table::hear(const std::vector<stream_metrics>& reported,
                        time_point now) {
  update(reported, now);
  const auto* breach = first_breach(now);
  if (breach == nullptr) {
    // Who has been starved is so until every input is fine.
    if (last_.health == instance_health::good || any_input_is_broken())
      return false;
    blamed_.clear();
    last_ = {};
    return true;
  }
  const auto health =
      breach->is_input ? instance_health::starved : instance_health::unhealthy;
  if (health == last_.health && breach->end == blamed_)
    return false;
  blamed_ = breach->end;
  last_ = {health,
           sentence_on(*breach, *find_stream(reported, breach->end), now)};
  return true;
}

void server_sight::hear(std::vector<std::string> missing, time_point now) {
  heard_ = true;
  missing_ = std::move(missing);
  if (missing_.empty())
    since_.reset();
  else if (!since_)
    since_ = now;
}

bool server_sight::judge(time_point now) {
  // Before the first word it is as it was, and while what is missing may yet
  // come, too.
  if (!heard_ || (since_ && now - *since_ < grace))
    return false;
  const bool did = std::exchange(misses_, since_.has_value());
  return misses_ != did;
}

std::string server_sight::reason() const {
  if (!misses_)
    return {};
  std::string result =
      "it is not known to its node's discovery server, which has not seen ";
  const char* before = "";
  for (const auto& x : missing_)
    result += std::exchange(before, ", ") + x;
  return result
         + ", so that nobody else hears of it; `roscell topics` and `roscell "
           "doctor` look for the cause";
}

} // namespace roscell
