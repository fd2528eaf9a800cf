#include "tools/roscell/doctor/host/kernel.hpp"

#include "tools/roscell/view/format.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace roscell::cli {

clock_readings read_clock() {
  timex clock{};
  const auto state = adjtimex(&clock);
  if (state < 0)
    return {};
  return {true, state != TIME_ERROR && (clock.status & STA_UNSYNC) == 0,
          clock.maxerror};
}

finding judge_clock(const clock_readings& clock) {
  if (!clock.reported)
    return {judgement::skipped, "the kernel does not report it"};
  constexpr auto why =
      "ages of frames between hosts, and the order of events and logs, are as "
      "wrong as the clocks differ";
  constexpr auto synchronise = "sudo timedatectl set-ntp true";
  if (!clock.synchronised)
    return {judgement::warning, "nothing synchronises the clock of this host",
            why, synchronise};
  // What a frame's age is good for is some milliseconds.
  constexpr int64_t most_error_us = 500'000;
  const auto seen =
      "the clock is synchronised, and wrong by "
      + format_number(static_cast<double>(clock.most_error_us) / 1000, 1)
      + " ms at most";
  if (clock.most_error_us > most_error_us)
    return {judgement::warning, seen, why,
            "chronyc tracking || timedatectl status"};
  return {judgement::ok, seen};
}

findings check_clock(const checked_host& /*host*/) {
  return {judge_clock(read_clock())};
}

namespace {

/// Sockets of members, peers, clients and instances of a large cell.
constexpr uint64_t few_descriptors = 4096;
constexpr uint64_t no_descriptors = 256;

namespace fs = std::filesystem;

/// Each skill that follows a file has one, and a node one for each log that is
/// followed.
constexpr int64_t wanted_instances = 32;
constexpr int64_t advised_instances = 1024;

bool is_process_of(const fs::path& folder, uid_t user) {
  const auto name = folder.filename().string();
  struct stat info {};
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; })
         && ::stat(folder.c_str(), &info) == 0 && info.st_uid == user;
}

int64_t instances_in(const fs::path& process) {
  int64_t result = 0;
  std::error_code error;
  for (fs::directory_iterator i{process / "fd", error}, end; !error && i != end;
       i.increment(error)) {
    std::error_code gone;
    if (fs::read_symlink(i->path(), gone) == "anon_inode:inotify")
      ++result;
  }
  return result;
}

} // namespace

inotify_readings read_inotify(const std::string& proc, uid_t user) {
  inotify_readings result;
  const fs::path root{proc};
  std::ifstream file{root / "sys/fs/inotify/max_user_instances"};
  if (!(file >> result.most))
    result.most = -1;
  std::error_code error;
  for (fs::directory_iterator i{root, error}, end; !error && i != end;
       i.increment(error))
    if (is_process_of(i->path(), user))
      result.used += instances_in(i->path());
  return result;
}

finding judge_inotify(const inotify_readings& seen) {
  if (seen.most < 0)
    return {judgement::skipped, "the kernel does not report inotify"};
  const auto text = std::to_string(seen.used) + " of "
                    + std::to_string(seen.most)
                    + " inotify instances of this user are in use";
  if (seen.most - seen.used >= wanted_instances)
    return {judgement::ok, text};
  return {
      judgement::warning, text,
      "each skill that follows a file, and each log that is followed, takes "
      "one: without it a skill looks once a second, and lines of a log come "
      "late",
      "sudo sysctl -w fs.inotify.max_user_instances="
          + std::to_string(std::max(advised_instances, 2 * seen.most))};
}

findings check_inotify(const checked_host& host) {
  return {judge_inotify(read_inotify(host.proc, ::geteuid()))};
}

finding judge_descriptors(uint64_t most) {
  const auto seen = "a process may open " + std::to_string(most) + " files";
  if (most >= few_descriptors)
    return {judgement::ok, seen};
  return {most < no_descriptors ? judgement::broken : judgement::warning, seen,
          "a node needs some for each member, client and instance, and refuses "
          "what it has none for",
          "sudo prlimit --pid $$ --nofile=65536:65536   # of this shell; of a "
          "service LimitNOFILE=65536"};
}

findings check_descriptors(const checked_host& /*host*/) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0)
    return {{judgement::skipped, "the kernel does not report it"}};
  return {judge_descriptors(limit.rlim_max)};
}

} // namespace roscell::cli
