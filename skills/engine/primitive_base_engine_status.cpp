#include "skills/engine/primitive_base_engine.hpp"

#include <algorithm>
#include <chrono>
#include <initializer_list>

/// What an engine says of its frames.
namespace roscell::engine {

namespace {

/// A node reads of no more, in either direction.
constexpr std::size_t most_counted = 16;

/// And no more bytes of a remark. What an author says has any length, and a
/// datagram that is too long is not read at all.
constexpr std::size_t most_remark_bytes = 256;

} // namespace

std::string primitive_base_engine::status() const {
  using namespace std::chrono;
  std::uint64_t dropped = 0;
  std::uint64_t failed = 0;
  for (std::size_t i = 0; i < env_.inputs.size(); ++i)
    if (work_.is_main(i)) {
      dropped += queue_.dropped(i);
      failed += work_.failed(i);
    }
  auto result = frame_text(work_.main_times(), dropped, failed);
  if (const auto& ages = outputs_.ages(); ages.count() > 0) {
    const auto median = duration_cast<microseconds>(ages.quantile(0.5));
    result += " age_us=" + std::to_string(median.count());
  }
  return result;
}

std::string primitive_base_engine::frame_counts() const {
  using namespace std::chrono;
  std::string result;
  const auto add = [&](const char* direction, std::size_t number,
                       std::initializer_list<std::uint64_t> counts) {
    result += (result.empty() ? "" : ";") + std::string{direction}
              + std::to_string(number);
    for (const auto count : counts)
      result += " " + std::to_string(count);
  };
  for (std::size_t i = 0; i < std::min(env_.inputs.size(), most_counted); ++i) {
    const auto& times = work_.times(i);
    const auto median = duration_cast<microseconds>(times.quantile(0.5));
    add("input:", i,
        {meters_.total_in(i), times.count(), work_.failed(i), queue_.dropped(i),
         static_cast<std::uint64_t>(median.count())});
  }
  for (std::size_t i = 0; i < std::min(env_.outputs.size(), most_counted); ++i)
    add("output:", i, {meters_.total_out(i)});
  return result;
}

std::string primitive_base_engine::reported_status() const {
  auto result = "STATUS=" + status() + "\nROSCELL_FRAMES=" + frame_counts();
  if (auto words = remark(); !words.empty()) {
    words.resize(std::min(words.size(), most_remark_bytes));
    // A datagram has one line for each thing.
    std::replace(words.begin(), words.end(), '\n', ' ');
    result += "\nROSCELL_REMARK=" + words;
  }
  return result;
}

} // namespace roscell::engine
