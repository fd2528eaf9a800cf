#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// What stands at `offset` in a log, and after it up to the next note, was
/// written then. A shim's file of times is an array of these.
struct time_note {
  int64_t offset = 0;
  int64_t unix_ms = 0;
};

/// When each line of `bytes`, or the rest of one, was written: the notes are in
/// the order of their offsets, and `from` is the offset of the first byte. 0
/// where no note tells.
std::vector<int64_t> line_times(std::string_view bytes, int64_t from,
                                const std::vector<time_note>& notes);

/// More lines of which each has its time make no part of a log: with a time
/// each, the shortest ones would not fit into an answer.
constexpr int64_t most_timed_lines = 8192;

/// How many bytes of a text its first so many lines have.
size_t bytes_of_lines(std::string_view text, int64_t lines);

/// Where its last so many lines begin. A newline at the very end ends the last
/// line and begins no other.
size_t begin_of_last_lines(std::string_view text, int64_t lines);

/// A part of an instance's log.
struct log_part {
  std::string text;        ///< Valid UTF-8; other bytes are replaced.
  int64_t next_offset = 0; ///< Of the first byte after the part.
  bool ended = false;      ///< Nothing will follow.
  /// For each line of `text`, or the rest of one; empty if it was not asked
  /// for, 0 where it is not known.
  std::vector<int64_t> times_unix_ms;
  std::string bytes; ///< In base64, where `text` is not what was logged.
};

/// Reads the bounded log that an instance's shim keeps in its folder: files
/// `log.<offset>`, named after the position of their first byte in all that was
/// ever logged, of which old ones disappear while we read. Blocks on the disk.
class instance_log {
public:
  static constexpr int64_t default_lines = 20;

  explicit instance_log(std::filesystem::path folder);

  /// Whether there is an instance's folder at all.
  bool exists() const;

  /// What stands at `offset` and after; the oldest that is still there if that
  /// is gone, nothing if it is not yet written. With `times`, also when.
  log_part read_from(int64_t offset, bool times = false) const;

  /// The last lines, as far as they fit into one part.
  log_part read_tail(int64_t lines = default_lines, bool times = false) const;

private:
  struct file {
    int64_t start = 0;
    int64_t size = 0;
  };

  /// Bytes without a gap between them.
  struct chunk {
    int64_t from = 0; ///< Offset of the first byte.
    std::string bytes;
    int64_t end = 0; ///< Offset behind the last byte of the whole log.
  };

  std::vector<file> files() const;
  std::string bytes(const file& x, int64_t from, int64_t most) const;
  chunk read(int64_t from) const;
  std::vector<time_note> notes(int64_t from, int64_t to) const;
  bool has_ended() const;

  std::filesystem::path folder_;
};

} // namespace roscell
