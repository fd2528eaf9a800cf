#include "actors/edge/dds/dds_thread.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <system_error>
#include <utility>
#include <vector>

#include <pthread.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <unistd.h>

namespace roscell {

namespace {

/// No UDP datagram is longer.
constexpr std::size_t largest_datagram = 65536;

/// Datagrams of one socket, until the others have their turn.
constexpr int most_in_a_row = 16;

/// The key of the timer descriptor, which no item has.
constexpr std::uint64_t timer_key = 0;

bool watch(int epoll, int fd, std::uint64_t key) {
  epoll_event wanted{};
  wanted.events = EPOLLIN;
  wanted.data.u64 = key;
  return epoll_ctl(epoll, EPOLL_CTL_ADD, fd, &wanted) == 0;
}

} // namespace

dds_thread::entry::entry(std::shared_ptr<dds_thread> owner, std::uint64_t key)
    : owner_(std::move(owner)), key_(key) {
  // nop
}

dds_thread::entry::~entry() {
  owner_->remove(key_);
}

void dds_thread::entry::call_at(clock::time_point due) {
  owner_->call_at(key_, due);
}

std::shared_ptr<dds_thread> dds_thread::shared() {
  static std::mutex mutex;
  static std::weak_ptr<dds_thread> present;
  const std::lock_guard lock{mutex};
  auto result = present.lock();
  if (!result || !result->works()) {
    result = std::make_shared<dds_thread>();
    present = result;
  }
  return result;
}

// The buffer is not zeroed: its pages cost nothing until they are needed.
dds_thread::dds_thread()
    : epoll_(epoll_create1(EPOLL_CLOEXEC)),
      timer_(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK)),
      buffer_(new std::uint8_t[largest_datagram]) {
  if (!works() || !watch(epoll_.get(), timer_.get(), timer_key))
    return;
  try {
    thread_ = std::thread{[this] {
      pthread_setname_np(pthread_self(), "roscell-dds");
      run();
    }};
  } catch (const std::system_error&) {
    // Who listens is told; the next one who asks for it gets another.
    timer_.reset();
  }
}

dds_thread::~dds_thread() {
  {
    const std::lock_guard lock{mutex_};
    closing_ = true;
    wake_at(clock::now());
  }
  if (thread_.joinable())
    thread_.join();
}

bool dds_thread::works() const {
  return epoll_ && timer_;
}

std::unique_ptr<dds_thread::entry>
dds_thread::listen(udp_socket socket, std::size_t max_bytes, on_datagram hear) {
  if (!works())
    return nullptr;
  auto x = std::make_shared<item>();
  const int fd = socket.fd();
  x->socket = std::move(socket);
  x->max_bytes = max_bytes;
  x->hear = std::move(hear);
  const auto key = add(std::move(x));
  auto result = std::make_unique<entry>(shared_from_this(), key);
  if (!watch(epoll_.get(), fd, key))
    return nullptr;
  return result;
}

std::unique_ptr<dds_thread::entry>
dds_thread::make_timer(std::function<void()> ring) {
  auto x = std::make_shared<item>();
  x->ring = std::move(ring);
  return std::make_unique<entry>(shared_from_this(), add(std::move(x)));
}

std::uint64_t dds_thread::add(std::shared_ptr<item> x) {
  const std::lock_guard lock{mutex_};
  items_.emplace(++last_key_, std::move(x));
  return last_key_;
}

void dds_thread::remove(std::uint64_t key) {
  std::shared_ptr<item> gone;
  std::unique_lock lock{mutex_};
  const auto found = items_.find(key);
  gone = std::move(found->second);
  items_.erase(found);
  if (gone->socket)
    epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, gone->socket->fd(), nullptr);
  if (std::this_thread::get_id() == thread_.get_id())
    return;
  ended_.wait(lock, [&] { return called_ != key; });
}

void dds_thread::call_at(std::uint64_t key, clock::time_point due) {
  const std::lock_guard lock{mutex_};
  items_.at(key)->due = due;
  arm();
}

void dds_thread::arm() {
  std::optional<clock::time_point> next;
  for (const auto& [key, x] : items_)
    if (x->due)
      next = next ? std::min(*next, *x->due) : *x->due;
  if (next && !closing_)
    wake_at(*next);
}

void dds_thread::wake_at(clock::time_point when) {
  using namespace std::chrono;
  // A time of zero would disarm it; one that has passed is due at once.
  const auto since = std::max<nanoseconds>(when.time_since_epoch(), 1ns);
  const auto whole = duration_cast<seconds>(since);
  itimerspec spec{};
  spec.it_value = {static_cast<time_t>(whole.count()),
                   static_cast<long>((since - whole).count())};
  timerfd_settime(timer_.get(), TFD_TIMER_ABSTIME, &spec, nullptr);
}

void dds_thread::run() {
  std::array<epoll_event, 16> events{};
  for (;;) {
    const int n = epoll_wait(epoll_.get(), events.data(),
                             static_cast<int>(events.size()), -1);
    for (int i = 0; i < n; ++i)
      if (const auto key = events.at(static_cast<std::size_t>(i)).data.u64;
          key != timer_key)
        hear(key);
    ring_due();
    const std::lock_guard lock{mutex_};
    if (closing_)
      return;
  }
}

void dds_thread::hear(std::uint64_t key) {
  for (int i = 0; i < most_in_a_row; ++i)
    if (!hear_one(key))
      return;
}

bool dds_thread::hear_one(std::uint64_t key) {
  auto x = begin(key);
  if (!x)
    return false;
  sockaddr_in from{};
  socklen_t from_size = sizeof(from);
  const auto size = recvfrom(x->socket->fd(), buffer_.get(), largest_datagram,
                             0, reinterpret_cast<sockaddr*>(&from), &from_size);
  const bool interrupted = size < 0 && errno == EINTR;
  if (size > 0 && static_cast<std::size_t>(size) <= x->max_bytes)
    x->hear(buffer_.get(), static_cast<std::size_t>(size), from);
  end(std::move(x));
  return size >= 0 || interrupted;
}

void dds_thread::ring_due() {
  std::uint64_t expirations = 0;
  while (::read(timer_.get(), &expirations, sizeof(expirations)) > 0)
    continue;
  std::vector<std::uint64_t> due;
  {
    const std::lock_guard lock{mutex_};
    const auto now = clock::now();
    for (const auto& [key, x] : items_)
      if (x->due && *x->due <= now) {
        x->due.reset();
        due.push_back(key);
      }
    arm();
  }
  for (const auto key : due)
    if (auto x = begin(key)) {
      x->ring();
      end(std::move(x));
    }
}

std::shared_ptr<dds_thread::item> dds_thread::begin(std::uint64_t key) {
  const std::lock_guard lock{mutex_};
  const auto found = items_.find(key);
  if (found == items_.end())
    return nullptr;
  called_ = key;
  return found->second;
}

void dds_thread::end(std::shared_ptr<item> x) {
  // What it holds is gone when who waits for that goes on.
  x.reset();
  {
    const std::lock_guard lock{mutex_};
    called_ = 0;
  }
  ended_.notify_all();
}

} // namespace roscell
