#include "skills/engine/life/signal_watch.hpp"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
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

} // namespace

fifo_watch::fifo_watch(std::vector<heard_lines> heard) {
  for (auto& x : heard)
    if (auto fifo = open_fifo(x.path))
      sources_.push_back({std::move(x), std::move(fifo), {}});
  if (!sources_.empty())
    thread_ = std::thread{[this] { run(); }};
}

fifo_watch::~fifo_watch() {
  stop_.set();
  if (thread_.joinable())
    thread_.join();
}

void fifo_watch::run() {
  std::vector<pollfd> waited{{stop_.fd(), POLLIN, 0}};
  for (const auto& x : sources_)
    waited.push_back({x.fifo.get(), POLLIN, 0});
  for (;;) {
    if (::poll(waited.data(), waited.size(), -1) < 1)
      continue; // Interrupted by a signal.
    if (waited[0].revents != 0)
      return;
    for (std::size_t i = 0; i < sources_.size(); ++i)
      if (waited[i + 1].revents != 0)
        take(sources_[i]);
  }
}

/// Of several lines each is obeyed: the last one counts in the end.
void fifo_watch::take(source& from) {
  std::array<char, 4096> bytes{};
  const auto size = ::read(from.fifo.get(), bytes.data(), bytes.size());
  if (size <= 0)
    return;
  auto& heard = from.begun;
  heard.append(bytes.data(), static_cast<std::size_t>(size));
  for (auto end = heard.find('\n'); end != std::string::npos;
       end = heard.find('\n')) {
    from.target.take(heard.substr(0, end));
    heard.erase(0, end + 1);
  }
  if (heard.size() > most_bytes)
    heard.clear();
}

changed_variables read_changed_variables(const std::string& line) {
  const auto document = nlohmann::json::parse(line, nullptr, false);
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

ordered_parameters read_parameter_line(const std::string& line) {
  const auto document = nlohmann::json::parse(line, nullptr, false);
  if (!document.is_object())
    return {};
  const auto number = document.find("number");
  const auto values = document.find("parameters");
  if (number == document.end() || !number->is_number_integer()
      || values == document.end() || !values->is_object())
    return {};
  return {number->get<std::int64_t>(), values->dump()};
}

request_answer read_answer_line(const std::string& line) {
  const auto document = nlohmann::json::parse(line, nullptr, false);
  if (!document.is_object())
    return {};
  const auto number = document.find("request");
  const auto problem = document.find("problem");
  if (number == document.end() || !number->is_number_integer()
      || problem == document.end() || !problem->is_string())
    return {};
  return {number->get<std::int64_t>(), problem->get<std::string>()};
}

} // namespace roscell::engine
