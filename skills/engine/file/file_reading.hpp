#pragma once

#include "roscell/skill/frame.hpp"
#include "roscell/skill/handlers.hpp"

#include <sys/stat.h>

#include <cstddef>
#include <optional>
#include <string>

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

} // namespace roscell::engine
