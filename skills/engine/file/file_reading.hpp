#pragma once

#include "roscell/skill/frame.hpp"
#include "roscell/skill/handlers.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace roscell::engine {

/// The parameters of the `file` protocol's inputs.
struct file_options {
  bool follow;
  bool loop;
  double rate_hz;
  std::size_t max_frame_bytes;
};

/// Throws start_error.
file_options read_file_options(const parameters& options);

/// Tells a file's content from any earlier one, without reading it.
struct file_identity {
  dev_t device = 0;
  ino_t inode = 0;
  off_t size = 0;
  timespec modified{};

  static file_identity of(const struct stat& info);

  bool operator==(const file_identity& other) const;
};

/// The path of the folder that holds `path`.
std::string parent_folder(const std::string& path);

/// The last component of `path`.
std::string base_name(const std::string& path);

/// The outcome of an attempt to read a whole file.
struct whole_file {
  frame content;
  file_identity identity;
};

/// Reads a regular file as one frame. Returns nothing when it is gone, is no
/// regular file, is too large, or cannot be read; the last two are said.
std::optional<whole_file> read_whole_file(const std::string& path,
                                          std::size_t max_bytes,
                                          const say_function& say);

/// Hears of changes in the file system, by inotify(7). A user has few instances
/// of it, 128 as a rule: whoever comes when they are in use looks at the files
/// once a second instead. Then each look comes as one event with IN_Q_OVERFLOW,
/// as where the kernel has lost some: anything may have changed.
class inotify_watch {
public:
  struct event {
    int watch;
    std::uint32_t mask;
    std::string name; ///< of the file in a watched folder, else empty
  };

  /// Says so if it has to look. Throws start_error when it cannot even do that.
  explicit inotify_watch(const say_function& say = nullptr);

  /// Whether it hears of nothing, and looks.
  bool looks() const noexcept {
    return looks_;
  }

  /// Whether a file may still be written to. Who hears of changes knows when a
  /// file is closed; who looks waits until it has been left alone for a second.
  bool may_be_unfinished(const struct stat& file) const;

  /// Watches a file or folder. Returns the number of the watch, or -1 with
  /// errno set.
  int add(const std::string& path, std::uint32_t mask);

  void remove(int watch);

  /// The events that have come in, which may be none.
  std::vector<event> read();

  /// Readable when there are events.
  int fd() const noexcept {
    return fd_.get();
  }

private:
  void poll_instead(const say_function& say);

  unique_fd fd_;
  bool looks_ = false;
  int last_watch_ = 0;
};

} // namespace roscell::engine
