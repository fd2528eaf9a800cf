#pragma once

#include <cstdint>

namespace roscell::shim {

/// The moment at which the command ends unless it is moved on before. It stands
/// in a file, in milliseconds of CLOCK_BOOTTIME, as one 64-bit number in the
/// machine's own order. That clock goes on while the host sleeps, and nobody
/// can set it. Whoever moves the moment on writes the file and wakes nobody:
/// the file is read again when the moment that was read last has come.
class fence {
public:
  fence() = default;

  ~fence();

  fence(const fence&) = delete;
  fence& operator=(const fence&) = delete;

  /// Holds the fence in the file of this path, which must stay valid. Returns
  /// false with errno set where none can be held, or its moment has passed.
  bool hold(const char* path);

  /// Readable when there is something to look at; negative: there is no fence.
  int timer() const {
    return timer_;
  }

  /// Returns whether the moment has passed. A file that cannot be read, or is
  /// too short, moves nothing on.
  bool has_passed();

private:
  bool wait_until(std::int64_t boot_ms) const;

  const char* path_ = nullptr;
  int timer_ = -1;
};

} // namespace roscell::shim
