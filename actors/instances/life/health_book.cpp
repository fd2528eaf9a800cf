#include "actors/instances/life/health_book.hpp"

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

const stream_figure* figure_of(const std::vector<stream_figure>& told,
                               const std::string& end) {
  const auto i = std::find_if(told.begin(), told.end(),
                              [&](const auto& x) { return x.end == end; });
  return i == told.end() ? nullptr : &*i;
}

std::string end_name(const char* direction, size_t number) {
  return direction + (":" + std::to_string(number));
}

} // namespace

bool has_bounds(const health_policy& policy) {
  return has_bounds(policy.inputs) || has_bounds(policy.outputs);
}

health_book::health_book(const instance_spec& spec, time_point ready_since,
                         std::vector<std::string> feeders,
                         health_verdict before)
    : grace_(std::chrono::duration_cast<steady_clock::duration>(
        duration<double>{spec.life.health.grace_s})),
      ready_since_(ready_since), last_(std::move(before)) {
  const auto& policy = spec.life.health;
  feeders.resize(spec.input.size());
  for (size_t i = 0; has_bounds(policy.inputs) && i < spec.input.size(); ++i)
    streams_.push_back({end_name("input", i),
                        "input '" + spec.input[i].endpoint + "'", policy.inputs,
                        std::move(feeders[i]), true, std::nullopt});
  for (size_t i = 0; has_bounds(policy.outputs) && i < spec.output.size(); ++i)
    streams_.push_back({end_name("output", i),
                        "output '" + spec.output[i].endpoint + "'",
                        policy.outputs, std::string{}, false, std::nullopt});
}

double health_book::age_of(const stream_figure& figure, time_point now) const {
  return figure.age_s >= 0 ? figure.age_s
                           : duration<double>{now - ready_since_}.count();
}

bool health_book::breaks(const stream& x, const stream_figure& figure,
                         time_point now) const {
  return figure.rate_hz < x.bounds.min_rate_hz
         || (x.bounds.max_age_s > 0
             && age_of(figure, now) > x.bounds.max_age_s);
}

void health_book::update(const std::vector<stream_figure>& told,
                         time_point now) {
  const bool was_silent =
      heard_ && now - *heard_ > grace_ + silence_beyond_grace;
  heard_ = now;
  for (auto& x : streams_) {
    const auto* figure = figure_of(told, x.end);
    if (figure == nullptr || !breaks(x, *figure, now))
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

bool health_book::any_input_is_broken() const {
  return std::any_of(streams_.begin(), streams_.end(), [](const stream& x) {
    return x.is_input && x.broken_since;
  });
}

const health_book::stream* health_book::first_breach(time_point now) const {
  const auto i =
      std::find_if(streams_.begin(), streams_.end(), [&](const stream& x) {
        return x.broken_since && now - *x.broken_since > grace_;
      });
  return i == streams_.end() ? nullptr : &*i;
}

std::string health_book::sentence_on(const stream& x,
                                     const stream_figure& figure,
                                     time_point now) const {
  std::string result = x.name;
  const auto age_s = age_of(figure, now);
  const bool is_old = x.bounds.max_age_s > 0 && age_s > x.bounds.max_age_s;
  if (is_old)
    result += " has had no frame for more than " + number(age_s)
              + " s, at most " + number(x.bounds.max_age_s) + " s are wanted";
  else
    result += std::string{x.is_input ? " comes" : " goes"} + " at "
              + number(figure.rate_hz) + " Hz, at least "
              + number(x.bounds.min_rate_hz) + " Hz are wanted";
  return x.feeder.empty() ? result : result + "; " + x.feeder;
}

bool health_book::hear(const std::vector<stream_figure>& told, time_point now) {
  update(told, now);
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
  last_ = {health, sentence_on(*breach, *figure_of(told, breach->end), now)};
  return true;
}

} // namespace roscell
