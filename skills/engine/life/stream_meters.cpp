#include "skills/engine/life/stream_meters.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>

namespace roscell::engine {

namespace {

using std::chrono::duration;

constexpr std::size_t most_reported = 16;

/// Frames that come in less than this are as good as one.
constexpr std::chrono::milliseconds least_span{1};

double rate_of(double frames, stream_meter::clock::duration span) {
  const auto bounded =
      std::max<stream_meter::clock::duration>(span, least_span);
  return frames / duration<double>{bounded}.count();
}

/// Three decimals and a point, whatever language the program has chosen.
std::string decimal(double value) {
  char text[400];
  const auto end = std::to_chars(std::begin(text), std::end(text), value,
                                 std::chars_format::fixed, 3)
                       .ptr;
  return {std::begin(text), end};
}

void add_metrics(std::string& text, const char* direction,
                 std::deque<stream_meter>& meters,
                 stream_meter::clock::time_point now) {
  for (std::size_t i = 0; i < std::min(meters.size(), most_reported); ++i) {
    const auto x = meters[i].take(now);
    text += (text.empty() ? "" : ";") + std::string{direction} + ":"
            + std::to_string(i) + " " + decimal(x.rate_hz) + " "
            + (x.age ? decimal(duration<double>{*x.age}.count()) : "-");
  }
}

} // namespace

void stream_meter::count(clock::time_point now) {
  std::lock_guard guard{mutex_};
  ++total_;
  ++frames_;
  last_ = now;
}

std::uint64_t stream_meter::total() const {
  std::lock_guard guard{mutex_};
  return total_;
}

stream_meter::measured stream_meter::take(clock::time_point now) {
  std::lock_guard guard{mutex_};
  if (!last_)
    return {};
  measured result;
  // A frame may have been counted since `now` was taken.
  result.age = std::max(now - *last_, clock::duration::zero());
  if (frames_ == 0) {
    result.rate_hz = rate_of(1, *result.age);
  } else {
    result.rate_hz =
        rate_of(static_cast<double>(frames_), *last_ - counted_to_);
    counted_to_ = *last_;
    frames_ = 0;
  }
  return result;
}

stream_meters::stream_meters(std::size_t inputs, std::size_t outputs,
                             clock::time_point begin) {
  for (std::size_t i = 0; i < inputs; ++i)
    inputs_.emplace_back(begin);
  for (std::size_t i = 0; i < outputs; ++i)
    outputs_.emplace_back(begin);
}

std::string stream_meters::take_text(clock::time_point now) {
  std::string result;
  add_metrics(result, "input", inputs_, now);
  add_metrics(result, "output", outputs_, now);
  return result;
}

} // namespace roscell::engine
