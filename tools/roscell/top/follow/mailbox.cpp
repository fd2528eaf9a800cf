#include "tools/roscell/top/follow/mailbox.hpp"

#include "tools/roscell/exit_code.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <utility>

namespace roscell::cli::top {

mailbox::mailbox() : fd_{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)} {
  if (fd_ < 0)
    throw command_error{exit_refused, "too many open files"};
}

mailbox::~mailbox() {
  close(fd_);
}

void mailbox::put(work x) {
  const std::lock_guard guard{mutex_};
  waiting_.push_back(std::move(x));
  eventfd_write(fd_, 1);
}

void mailbox::work_off() {
  std::vector<work> due;
  {
    const std::lock_guard guard{mutex_};
    eventfd_t count = 0;
    eventfd_read(fd_, &count);
    due = std::exchange(waiting_, {});
  }
  for (const auto& x : due)
    x();
}

} // namespace roscell::cli::top
