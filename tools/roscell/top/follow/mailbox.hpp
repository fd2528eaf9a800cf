#pragma once

#include <functional>
#include <mutex>
#include <vector>

namespace roscell::cli::top {

/// What threads want done by the one that draws, which waits for a descriptor.
class mailbox {
public:
  using work = std::function<void()>;

  mailbox();
  ~mailbox();

  mailbox(const mailbox&) = delete;
  mailbox& operator=(const mailbox&) = delete;

  void put(work x);

  /// Does all that is there, in order. The descriptor is not readable any more
  /// then.
  void work_off();

  /// Readable while there is something.
  int fd() const {
    return fd_;
  }

private:
  int fd_;
  std::mutex mutex_;
  std::vector<work> waiting_;
};

} // namespace roscell::cli::top
