#pragma once

#include <atomic>
#include <optional>

namespace roscell::engine {

/// Whether a skill may be ended now, as its author has said last. All members
/// may be called from any thread, and none blocks.
class safe_state {
public:
  /// Throws std::system_error when the process has no file descriptor left.
  safe_state();

  ~safe_state();

  safe_state(const safe_state&) = delete;
  safe_state& operator=(const safe_state&) = delete;

  void set(bool safe) noexcept;

  /// Nothing before the first `set`.
  std::optional<bool> get() const noexcept;

  /// Becomes readable when the word has changed, until it is read from; for use
  /// in poll() by the one who passes it on.
  int fd() const noexcept {
    return fd_;
  }

private:
  enum class word { untold, unsafe, safe };

  std::atomic<word> word_{word::untold};
  const int fd_;
};

} // namespace roscell::engine
