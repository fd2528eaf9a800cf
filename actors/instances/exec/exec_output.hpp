#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace roscell {

/// What a command has written and nobody has acknowledged yet. An offset is a
/// place in all that it has ever written, to both of its outputs.
class exec_backlog {
public:
  /// The next part: bytes of one output.
  struct part {
    std::string bytes;
    bool of_errors = false;
    int64_t next_offset = 0;
    bool is_last = false; ///< Nothing waits behind it.
  };

  void add(bool of_errors, std::string bytes);

  /// Whether more may be read of the command.
  bool has_room() const;

  /// All before `offset` has come. False: nothing could have been asked for
  /// there.
  bool acknowledge(int64_t offset);

  part front() const;

  bool empty() const {
    return runs_.empty();
  }

  size_t size() const {
    return size_;
  }

private:
  struct run {
    bool of_errors = false;
    std::string bytes;
  };

  std::deque<run> runs_;
  size_t size_ = 0;
  int64_t begin_ = 0; ///< Offset of the first byte that waits.
};

} // namespace roscell
