#include "skills/engine/life/signal_watch.hpp"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/signalfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>
#include <utility>

namespace roscell::engine {

namespace {

sigset_t watched_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGTERM);
  ::sigaddset(&set, SIGINT);
  ::sigaddset(&set, SIGUSR1);
  return set;
}

} // namespace

void block_signals() {
  auto set = watched_signals();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

signal_watch::signal_watch(std::function<void()> on_stop,
                           std::function<void()> on_safety_wanted)
    : on_stop_(std::move(on_stop)),
      on_safety_wanted_(std::move(on_safety_wanted)) {
  auto set = watched_signals();
  signals_ = unique_fd{::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK)};
  if (!signals_)
    throw std::system_error(errno, std::generic_category(), "signalfd");
  thread_ = std::thread{[this] { run(); }};
}

signal_watch::~signal_watch() {
  stop_.set();
  thread_.join();
}

void signal_watch::run() {
  while (stop_.wait_readable(signals_.get())) {
    signalfd_siginfo reported{};
    if (::read(signals_.get(), &reported, sizeof(reported)) != sizeof(reported))
      continue;
    if (reported.ssi_signo != SIGUSR1)
      return on_stop_();
    on_safety_wanted_();
  }
}

namespace {

constexpr std::size_t most_bytes = 64UL * 1024;

/// None where there is no FIFO. That it is open for writing, too, keeps it from
/// ending whenever the node has written.
unique_fd open_fifo(const std::string& path) {
  unique_fd result{
      ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW)};
  struct stat status {};
  if (result
      && (::fstat(result.get(), &status) != 0 || !S_ISFIFO(status.st_mode)))
    return {};
  return result;
}

/// Empty for what is no such object.
changed_variables read_variables(std::string_view text) {
  const auto document = nlohmann::json::parse(text, nullptr, false);
  changed_variables result;
  if (!document.is_object())
    return result;
  for (const auto& [name, value] : document.items()) {
    if (!value.is_string())
      return {};
    result[name] = value.get<std::string>();
  }
  return result;
}

} // namespace

environment_watch::environment_watch(const std::string& notify_socket,
                                     callback on_change)
    : on_change_(std::move(on_change)),
      fifo_(open_fifo(notify_socket + ".environment")) {
  if (fifo_)
    thread_ = std::thread{[this] { run(); }};
}

environment_watch::~environment_watch() {
  stop_.set();
  if (thread_.joinable())
    thread_.join();
}

void environment_watch::run() {
  while (stop_.wait_readable(fifo_.get()))
    take();
}

/// Of several lines each is obeyed: the last one counts in the end.
void environment_watch::take() {
  std::array<char, 4096> bytes{};
  const auto size = ::read(fifo_.get(), bytes.data(), bytes.size());
  if (size <= 0)
    return;
  heard_.append(bytes.data(), static_cast<std::size_t>(size));
  for (auto end = heard_.find('\n'); end != std::string::npos;
       end = heard_.find('\n')) {
    obey(heard_.substr(0, end));
    heard_.erase(0, end + 1);
  }
  if (heard_.size() > most_bytes)
    heard_.clear();
}

void environment_watch::obey(const std::string& line) {
  auto reported = read_variables(line);
  if (!reported.empty())
    on_change_(std::move(reported));
}

} // namespace roscell::engine
