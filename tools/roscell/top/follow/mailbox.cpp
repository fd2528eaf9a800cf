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

void mailbox::put(news x) {
  const std::lock_guard guard{mutex_};
  news_.push_back(std::move(x));
  eventfd_write(fd_, 1);
}

std::vector<news> mailbox::take() {
  const std::lock_guard guard{mutex_};
  eventfd_t count = 0;
  eventfd_read(fd_, &count);
  return std::exchange(news_, {});
}

} // namespace roscell::cli::top
