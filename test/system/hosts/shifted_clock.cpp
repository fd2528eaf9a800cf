#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>

// A library to be preloaded: the process's wall clock is off by
// $CLOCK_OFFSET_S seconds, as on a host that nobody has set; its other clocks
// are as they are. Network namespaces share the kernel's clock.

extern "C" __attribute__((visibility("default"))) int
clock_gettime(clockid_t clock, timespec* now) noexcept {
  const auto failed = static_cast<int>(syscall(SYS_clock_gettime, clock, now));
  const char* offset_s = std::getenv("CLOCK_OFFSET_S");
  if (failed == 0 && clock == CLOCK_REALTIME && offset_s != nullptr)
    now->tv_sec += std::atoi(offset_s);
  return failed;
}
