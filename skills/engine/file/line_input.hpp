#pragma once

#include "roscell/skill/handlers.hpp"
#include "roscell/skill/pacer.hpp"
#include "skills/engine/file/file_reading.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace roscell::engine {

/// Cuts a stream of bytes into lines. Holds at most one line of `max_bytes`
/// and the last chunk; a longer line is left out, but counted.
class line_splitter {
public:
  explicit line_splitter(std::size_t max_bytes) : max_bytes_(max_bytes) {
    // nop
  }

  /// Adds bytes. To be called when `next` has returned nothing.
  void feed(std::string_view bytes);

  /// The next complete line, without its newline.
  std::optional<std::string> next();

  /// What follows the last newline, if anything, as a line of its own.
  std::optional<std::string> rest();

  /// Whether there are bytes after the last newline.
  bool has_rest() const noexcept {
    return position_ < buffer_.size() || skipping_;
  }

  /// Number of the line that was returned last, counted from 1.
  std::uint64_t line_number() const noexcept {
    return lines_;
  }

  /// Lines that were too long.
  std::uint64_t too_long() const noexcept {
    return too_long_;
  }

private:
  bool accept(std::size_t size);

  const std::size_t max_bytes_;
  std::string buffer_;
  std::size_t position_ = 0;
  std::size_t searched_ = 0;
  std::uint64_t lines_ = 0;
  std::uint64_t too_long_ = 0;
  bool skipping_ = false;
};

/// Reads a regular file line by line and follows its growth, its truncation
/// and its replacement by another file. See file_protocol.hpp.
class line_input : public input_handler {
public:
  explicit line_input(const stream_context& input);

  void open() override;
  void run(frame_sink& sink, const stop_event& stop) override;

  bool survives_new_address() const override {
    return true;
  }

private:
  bool open_file();
  void watch_file();
  bool push(frame_sink& sink, const stop_event& stop, std::string line);
  bool push_lines(frame_sink& sink, const stop_event& stop);
  bool push_rest(frame_sink& sink, const stop_event& stop);
  bool push_all(frame_sink& sink, const stop_event& stop);
  bool on_change(frame_sink& sink, const stop_event& stop);
  bool was_replaced() const;
  bool was_truncated() const;
  void say_if_too_long();
  void say_if_held_back();

  const std::string path_;
  const file_options options_;
  const say_function say_;
  line_splitter splitter_;
  pacer pacer_;
  std::optional<inotify_watch> changes_;
  int file_watch_ = -1;
  unique_fd file_;
  off_t offset_ = 0;
  std::uint64_t too_long_said_ = 0;
  bool held_back_said_ = false;
};

} // namespace roscell::engine
