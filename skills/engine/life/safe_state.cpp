#include "roscell/skill/safe_state.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

namespace roscell::engine {

safe_state::safe_state() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0)
    throw std::system_error(errno, std::generic_category(), "eventfd");
}

safe_state::~safe_state() {
  ::close(fd_);
}

void safe_state::set(bool safe) noexcept {
  const auto next = safe ? word::safe : word::unsafe;
  if (word_.exchange(next) == next)
    return;
  std::uint64_t one = 1;
  [[maybe_unused]] auto n = ::write(fd_, &one, sizeof(one));
}

std::optional<bool> safe_state::get() const noexcept {
  const auto last = word_.load();
  if (last == word::untold)
    return std::nullopt;
  return last == word::safe;
}

} // namespace roscell::engine
