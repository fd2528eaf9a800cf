#include "embedding/surroundings.hpp"

#include "roscell/node.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>

namespace roscell::embedding {

namespace {

/// What Fast DDS 2.9 reads in the working directory.
constexpr const char* profiles_file = "DEFAULT_FASTRTPS_PROFILES.xml";

bool is_set(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

bool reads_profiles_file() {
  const char* skip = std::getenv("SKIP_DEFAULT_XML");
  return skip == nullptr || std::string{skip} != "1";
}

} // namespace

void check_surroundings() {
  for (const char* name : {"ROS_DISCOVERY_SERVER", "FASTDDS_ENVIRONMENT_FILE",
                           "FASTRTPS_DEFAULT_PROFILES_FILE"})
    if (is_set(name))
      throw node_error{
          "conflict",
          std::string{name} + " is set in this process and would mislead DDS",
          std::string{"unset "} + name + " before this program starts"};
  std::error_code ignored;
  if (reads_profiles_file() && std::filesystem::exists(profiles_file, ignored))
    throw node_error{"conflict",
                     std::string{profiles_file}
                         + " in the working directory would mislead DDS",
                     "set SKIP_DEFAULT_XML=1 before this program starts, or "
                     "start it elsewhere"};
}

namespace {

constexpr int highest_nice = 19;

void check(const node_threads& how) {
  for (const auto cpu : how.cpus)
    if (cpu >= CPU_SETSIZE)
      throw node_error{"schema_violation",
                       "there is no core " + std::to_string(cpu), ""};
  if (how.nice < 0 || how.nice > highest_nice)
    throw node_error{"schema_violation",
                     "a nice value of " + std::to_string(how.nice)
                         + " is not possible",
                     "give 0 to 19"};
}

void use_cores(const std::vector<unsigned>& cpus) {
  if (cpus.empty())
    return;
  cpu_set_t set;
  CPU_ZERO(&set);
  std::string names;
  for (const auto cpu : cpus) {
    CPU_SET(cpu, &set);
    names += (names.empty() ? "" : ", ") + std::to_string(cpu);
  }
  if (::sched_setaffinity(0, sizeof(set), &set) != 0)
    throw node_error{"schema_violation",
                     "threads cannot run on the cores " + names,
                     "`taskset -p $$` shows those that may be used"};
}

/// Of the calling thread; on Linux both are a thread's own.
void use_priority(int nice) {
  const sched_param ordinary{};
  ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
  const auto self = static_cast<id_t>(::syscall(SYS_gettid));
  const int present = ::getpriority(PRIO_PROCESS, self);
  ::setpriority(PRIO_PROCESS, self, std::max(nice, present));
}

} // namespace

void run_on_own_thread(const node_threads& how,
                       const std::function<void()>& work) {
  check(how);
  std::exception_ptr thrown;
  std::thread{[&] {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, nullptr);
    try {
      use_cores(how.cpus);
      use_priority(how.nice);
      work();
    } catch (...) {
      thrown = std::current_exception();
    }
  }}.join();
  if (thrown)
    std::rethrow_exception(thrown);
}

} // namespace roscell::embedding
