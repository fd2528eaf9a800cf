#pragma once

#include "roscell/skill/handlers.hpp"
#include "roscell/skill/pacer.hpp"
#include "skills/engine/file/file_reading.hpp"

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace roscell::engine {

/// Reads the regular files of a folder in the order of their names, and then
/// those that are renamed into it or closed by a writer, in that order. See
/// file_protocol.hpp.
class folder_input : public input_handler {
public:
  explicit folder_input(const stream_context& input);

  void open() override;
  void run(frame_sink& sink, const stop_event& stop) override;

  bool survives_new_address() const override {
    return true;
  }

private:
  std::vector<std::string> list() const;
  bool is_left_out(const std::string& name) const;
  bool push_all(frame_sink& sink, const stop_event& stop);
  bool push_file(const std::string& name, frame_sink& sink,
                 const stop_event& stop);
  bool on_event(const inotify_watch::event& e, frame_sink& sink,
                const stop_event& stop);
  bool begin_again(frame_sink& sink, const stop_event& stop);
  bool follow(frame_sink& sink, const stop_event& stop);

  const std::string path_;
  const file_options options_;
  const bool images_only_;
  const say_function say_;
  pacer pacer_;
  std::optional<inotify_watch> changes_;
  /// What has been read of each file that is in the folder now, because a
  /// file may be found both by listing and by an event.
  std::unordered_map<std::string, file_identity> done_;
};

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
