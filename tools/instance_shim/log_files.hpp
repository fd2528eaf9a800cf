#pragma once

#include <cstddef>
#include <cstdint>

namespace roscell::shim {

/// A log of bounded size. Its files are named `log.<offset>`, where the offset
/// is the position of the file's first byte in all that was ever logged; the
/// two newest are kept, each of at most half the bound. Beside each lies
/// `times.<offset>`, of at most a quarter of its bound: pairs of 64-bit numbers
/// in the machine's own order, an offset and the milliseconds since 1970 at
/// which what stands there and after was written. Never waits and never fails:
/// what cannot be written is lost, and a line in the log says how much as soon
/// as one can be written.
class log_files {
public:
  /// Continues the log in the folder `directory`, an open descriptor that must
  /// stay open, with a line that says so, or begins one. It goes on in the
  /// newest file: a program that is started again and again must not leave a
  /// file each time.
  log_files(int directory, std::uint64_t max_bytes);

  ~log_files();

  log_files(const log_files&) = delete;
  log_files& operator=(const log_files&) = delete;

  void write(const char* data, std::size_t size);

  /// Gives up the older file, to make room for something more important.
  void drop_older();

private:
  void find_newest();
  void go_on_in(std::uint64_t newest);
  void find_last_note();
  void note_start();
  void remove(std::uint64_t offset);
  bool ensure_open();
  bool ensure_times_open();
  bool is_full() const;
  void note_time();
  void rotate();
  std::size_t append(const char* data, std::size_t size);
  void note_loss();

  const int directory_;
  const std::uint64_t max_file_bytes_;
  int file_ = -1;
  int times_ = -1;
  std::int64_t noted_ms_ = 0; ///< The last time in the newest file of times.
  std::uint64_t times_size_ = 0;
  std::uint64_t start_ = 0;
  std::uint64_t size_ = 0;
  std::uint64_t older_start_ = 0;
  bool has_older_ = false;
  std::uint64_t lost_bytes_ = 0;
};

} // namespace roscell::shim
