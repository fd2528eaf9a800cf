#include "actors/edge/process/process_identity.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "messages/codec/json_codec.hpp"

#include <poll.h>
#include <sys/wait.h>

#include <algorithm>
#include <charconv>
#include <system_error>
#include <vector>

namespace roscell {

namespace {

namespace fs = std::filesystem;

/// More than the longest record or line of /proc that is read here.
constexpr size_t max_record_bytes = 4096;

/// More than the command line of any shim: the kernel's own bound is 2 MiB.
constexpr size_t max_command_bytes = 2 * 1024 * 1024;

/// Position of the start time among the fields that follow the name.
constexpr size_t start_time_field = 19;

template <class T>
std::optional<T> number(std::string_view text) {
  T result{};
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, result);
  if (error != std::errc{} || rest != end)
    return std::nullopt;
  return result;
}

std::vector<std::string_view> fields_of(std::string_view text) {
  std::vector<std::string_view> result;
  constexpr std::string_view blanks = " \n";
  for (auto begin = text.find_first_not_of(blanks);
       begin != std::string_view::npos;
       begin = text.find_first_not_of(blanks, begin)) {
    const auto end = std::min(text.find_first_of(blanks, begin), text.size());
    result.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return result;
}

fs::path proc_file(pid_t pid, const char* name,
                   const fs::path& proc = "/proc") {
  return proc / std::to_string(pid) / name;
}

bool has_argument(pid_t pid, const std::string& ending) {
  const auto text =
      read_small_file(proc_file(pid, "cmdline"), max_command_bytes);
  return text && text->find(ending + '\0') != std::string::npos;
}

std::optional<process_identity> identity_of(std::string_view pid,
                                            std::string_view start_time) {
  const auto number_of_it = number<pid_t>(pid);
  const auto start = number<uint64_t>(start_time);
  if (!number_of_it || *number_of_it <= 0 || !start)
    return std::nullopt;
  return process_identity{*number_of_it, *start};
}

} // namespace

std::string to_container(const process_identity& process) {
  return std::to_string(process.pid) + ':' + std::to_string(process.start_time);
}

std::optional<process_identity> process_of(std::string_view container) {
  const auto colon = container.find(':');
  if (colon == std::string_view::npos)
    return std::nullopt;
  return identity_of(container.substr(0, colon), container.substr(colon + 1));
}

std::optional<process_identity> identify(pid_t pid, const fs::path& proc) {
  const auto text =
      read_small_file(proc_file(pid, "stat", proc), max_record_bytes);
  if (!text)
    return std::nullopt;
  // The name may itself hold blanks and parentheses.
  const auto name_end = text->rfind(')');
  if (name_end == std::string::npos)
    return std::nullopt;
  const auto fields = fields_of(std::string_view{*text}.substr(name_end + 1));
  if (fields.size() <= start_time_field)
    return std::nullopt;
  return identity_of(std::to_string(pid), fields[start_time_field]);
}

unique_fd open_process(const process_identity& process,
                       const std::string& marker) {
  unique_fd result{::pidfd_open(process.pid, 0)};
  if (!result)
    return {};
  // Read after the descriptor was made: if the number had been given away
  // before, this is another start time.
  const auto present = identify(process.pid);
  if (!present || present->start_time != process.start_time)
    return {};
  if (!marker.empty() && !has_argument(process.pid, marker))
    return {};
  return result;
}

bool has_ended(int pidfd) {
  pollfd waited{pidfd, POLLIN, 0};
  return ::poll(&waited, 1, 0) != 0;
}

std::optional<int> reap(int pidfd) {
  siginfo_t info{};
  if (::waitid(P_PIDFD, static_cast<id_t>(pidfd), &info, WEXITED | WNOHANG) != 0
      || info.si_pid == 0)
    return std::nullopt;
  return info.si_code == CLD_EXITED ? info.si_status : 128 + info.si_status;
}

std::optional<process_identity> read_pid_record(const fs::path& dir) {
  std::error_code error;
  const auto link = fs::read_symlink(dir / "pid", error);
  // The shims of earlier versions have written a file.
  const auto text = error ? read_small_file(dir / "pid", max_record_bytes)
                          : std::optional{link.native()};
  if (!text)
    return std::nullopt;
  const auto fields = fields_of(*text);
  if (fields.size() != 3)
    return std::nullopt;
  return identity_of(fields[0], fields[1]);
}

std::optional<recorded_end> read_exit_record(const fs::path& dir) {
  const auto text = read_small_file(dir / exit_record_name, max_record_bytes);
  const auto record = text ? json::parse(*text, nullptr, false) : json(nullptr);
  if (!record.is_object())
    return std::nullopt;
  const auto field = [&](const char* name) {
    const auto i = record.find(name);
    return i != record.end() && i->is_number_integer() ? i->get<int64_t>() : -1;
  };
  const auto terminated = record.find("terminated");
  recorded_end result;
  result.terminated = terminated != record.end() && *terminated == true;
  constexpr double mib = 1024.0 * 1024.0;
  result.memory_kills = std::max<int64_t>(0, field("memory_kills"));
  if (const auto most = field("most_memory_bytes"); most >= 0)
    result.most_memory_mib = static_cast<double>(most) / mib;
  const auto code = field("code");
  const auto signal = field("signal");
  if (code >= 0 && code <= 255)
    result.exit_code = static_cast<int>(code);
  else if (signal > 0 && signal < 128)
    result.exit_code = static_cast<int>(128 + signal);
  else
    return std::nullopt;
  return result;
}

} // namespace roscell
