#pragma once

#include "roscell/skill/handlers.hpp"
#include "roscell/skill/pacer.hpp"
#include "skills/engine/file/file_reading.hpp"
#include "skills/engine/file/inotify_watch.hpp"

#include <optional>
#include <string>

namespace roscell::engine {

/// Reads one regular file as one frame, and again whenever it is replaced or
/// a writer closes it. See file_protocol.hpp.
class whole_file_input : public input_handler {
public:
  explicit whole_file_input(const stream_context& input);

  void open() override;
  void run(frame_sink& sink, const stop_event& stop) override;

  bool survives_new_address() const override {
    return true;
  }

private:
  void watch_file();
  bool push_if_new(frame_sink& sink, const stop_event& stop);
  bool concerns_file(const inotify_watch::event& e) const;

  const std::string path_;
  const file_options options_;
  const say_function say_;
  pacer pacer_;
  std::optional<inotify_watch> changes_;
  int file_watch_ = -1;
  file_identity last_;
};

} // namespace roscell::engine
