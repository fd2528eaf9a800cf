#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace roscell::engine {

/// How long `process` took, over the whole life of a skill. A histogram of
/// fixed size (8 KiB): each power of two of a nanosecond is split into 16
/// buckets of equal width, so a quantile is off by at most 1/32 of its value.
/// All members may be called from any thread.
class processing_times {
public:
  using duration = std::chrono::nanoseconds;

  /// Upper bounds by which a node counts the frames of all its skills alike,
  /// so that those of several can be added.
  static constexpr std::array<std::uint64_t, 10> bounds_ms{
      1, 2, 5, 10, 20, 50, 100, 200, 500, 1000};

  /// All times in a few exact numbers that belong together.
  struct tally {
    std::uint64_t count = 0;
    std::uint64_t sum_ns = 0;
    /// How many lie up to each of `bounds_ms` and above the one before it; the
    /// last are those beyond all.
    std::array<std::uint64_t, bounds_ms.size() + 1> counts{};
  };

  void add(duration time);

  std::uint64_t count() const;

  tally tallied() const;

  /// The time that a share `q`, from 0 to 1, of all calls did not exceed; zero
  /// when there were none. `quantile(0.5)` is the median.
  duration quantile(double q) const;

private:
  mutable std::mutex mutex_;
  std::array<std::uint64_t, 976> buckets_{};
  tally tally_;
};

/// What a status says of the frames that a skill has processed: "frames=120
/// dropped=0 failed=0 median_us=85 p99_us=210 times_us=10900
/// times=119,1,0,0,0,0,0,0,0,0,0". The last are the counts of a `tally`, which
/// add up to the frames.
std::string frame_text(const processing_times& times, std::uint64_t dropped,
                       std::uint64_t failed);

/// What became of the frames of one input.
struct handled_frame {
  processing_times::duration time{}; ///< Without the writing of results.
  bool failed = false;
  std::size_t results = 0;
  std::string reason; ///< Why it has failed, or why nothing has come of it.
};

/// What a skill has made of the frames of each input, and what it says where
/// nothing comes of them. Failures are no work done. Those in a row are counted
/// for each input by itself, so that a good one does not hide a bad one. All
/// members may be called from any thread.
class input_work {
public:
  explicit input_work(const std::vector<std::string>& data_types);

  /// Frames of this input are what the skill works on, and so are those of
  /// inputs of the same data type. The first input, unless it is said.
  void set_main(std::size_t input);

  void add(std::size_t input, const handled_frame& x);

  std::uint64_t failed(std::size_t input) const;

  /// Since the last frame that did not fail.
  std::uint64_t failed_in_row(std::size_t input) const;

  const processing_times& times(std::size_t input) const {
    return inputs_[input].times;
  }

  /// Of the inputs that the skill works on.
  const processing_times& main_times() const {
    return main_times_;
  }

  bool is_main(std::size_t input) const;

  /// One sentence on an input that the skill works on and that has brought many
  /// frames of which nothing has come, e.g. "118 frames in, none out: no
  /// CameraInfo has come". Empty: there is none; the skill may well find
  /// nothing in a frame, so it is one of which nothing has ever come, or of
  /// which the skill says why.
  std::string remark() const;

private:
  struct input_tally {
    std::string data_type;
    processing_times times;
    std::uint64_t failed = 0;
    std::uint64_t failed_in_row = 0;
    std::uint64_t fruitless = 0; ///< Frames since the last result.
    bool was_fruitful = false;
    std::string reason; ///< Of the last frame of which nothing has come.
  };

  mutable std::mutex mutex_;
  std::deque<input_tally> inputs_;
  std::string main_type_;
  processing_times main_times_;
};

} // namespace roscell::engine
