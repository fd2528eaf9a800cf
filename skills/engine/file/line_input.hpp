#pragma once

#include "roscell/skill/handlers.hpp"
#include "roscell/skill/pacer.hpp"
#include "skills/engine/file/file_reading.hpp"
#include "skills/engine/file/inotify_watch.hpp"
#include "skills/engine/file/line_splitter.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <optional>
#include <string>

namespace roscell::engine {

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
