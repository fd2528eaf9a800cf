#pragma once

#include "actors/edge/limits.hpp"
#include "actors/edge/process/instance_log.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// When a line was logged, in ticks of 100 ns since 1970: fine enough to tell
/// the lines of a program apart, and coarse enough that the ticks since a
/// container's creation stay exact as JSON numbers for 28 years.
using log_ticks = int64_t;

constexpr log_ticks log_ticks_per_ms = 10'000;

/// Reads "2026-11-21T20:54:31.457426139Z", or with "+01:00" at its end.
/// Nothing for any other text.
std::optional<log_ticks> parse_log_time(std::string_view text);

/// Cuts the stream of an engine's log into its frames: a byte for the stream,
/// three zeros, the size in network byte order, and so many bytes.
class log_frames {
public:
  /// Engines cut lines at 16 KiB; a larger frame is no log.
  static constexpr size_t max_frame_bytes = 1024 * 1024;

  /// Adds bytes as they come.
  void add(std::string_view bytes);

  /// The next whole frame's bytes, until `add` is called; nothing if none is
  /// whole yet, or after what is no frame.
  std::optional<std::string_view> next();

  /// It is no such stream.
  bool broken() const {
    return broken_;
  }

private:
  std::string rest_;
  size_t at_ = 0; ///< Where in `rest_` the next frame begins.
  bool broken_ = false;
};

/// Which part of an engine's log is wanted.
struct log_range {
  log_ticks origin = 0;   ///< Offsets count from here.
  int64_t from = 0;       ///< Offset of the first line that is wanted.
  bool last_part = false; ///< If it is too long, the end of it is wanted.
  bool times = false;     ///< The times of the lines are wanted.
  size_t most_bytes = limits::log::part_bytes; ///< In one part.
  int64_t most_lines = most_timed_lines;       ///< The same, with their times.
};

/// Collects one part of an engine's log, whose lines carry their times. An
/// offset is the time of a line, in ticks since the origin.
class log_collector {
public:
  explicit log_collector(log_range range);

  /// Takes bytes of the stream; false if the part is full, or the stream is
  /// no log.
  bool take(std::string_view bytes);

  /// What has been collected. `ended` is not known here.
  log_part part() const;

  bool empty() const {
    return text_.empty();
  }

private:
  bool take_frame(std::string_view frame);
  void forget_front(size_t bytes);

  log_range range_;
  log_frames frames_;
  std::string text_;
  int64_t next_offset_;
  /// When what stands there in `text_` was logged; the rest of a line that an
  /// engine has cut is as old as its beginning.
  std::vector<time_note> notes_;
};

} // namespace roscell
