#include "actors/edge/io/io_thread.hpp"

#include "actors/edge/io/io_core.hpp"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include <pthread.h>

#include <csignal>
#include <utility>

namespace roscell {

io_core::io_core(edge_log log) : log_(std::move(log)) {
  // nop
}

void io_core::post(std::function<void()> task) {
  const std::lock_guard guard{mutex_};
  if (!stopping_)
    boost::asio::post(context_, std::move(task));
}

void io_core::adopt(std::shared_ptr<io_component> component) {
  const auto* key = component.get();
  components_.emplace(key, std::move(component));
}

void io_core::release(const io_component* component) {
  components_.erase(component);
}

void io_core::log(const std::string& sentence) {
  if (!log_)
    return;
  try {
    log_(sentence);
  } catch (...) {
    // A log that fails has nobody left to tell.
    log_ = nullptr;
  }
}

void io_core::run() {
  auto work = boost::asio::make_work_guard(context_);
  while (!context_.stopped())
    guarded([this] { context_.run(); });
  context_.shutdown();
}

void io_core::stop() {
  const std::lock_guard guard{mutex_};
  if (std::exchange(stopping_, true))
    return;
  boost::asio::post(context_, [this] {
    close_components();
    context_.stop();
  });
}

void io_core::close_components() {
  // Closing one releases it, and may close others.
  while (!components_.empty()) {
    const auto component = components_.begin()->second;
    components_.erase(components_.begin());
    guarded([&] { component->on_io_stop(); });
  }
}

namespace {

/// This thread takes no signals meanwhile, nor what it starts, ever.
class blocked_signals {
public:
  blocked_signals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }

  ~blocked_signals() {
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

  blocked_signals(const blocked_signals&) = delete;
  blocked_signals& operator=(const blocked_signals&) = delete;

private:
  sigset_t before_{};
};

/// Starts a thread that takes no signals: they belong to the owner's threads.
/// Throws where no thread can be had.
std::thread start_without_signals(std::shared_ptr<io_core> core) {
  const blocked_signals meanwhile;
  return std::thread{[core = std::move(core)] {
    pthread_setname_np(pthread_self(), "roscell-io");
    core->run();
  }};
}

} // namespace

io_thread::io_thread(edge_log log)
    : core_(std::make_shared<io_core>(std::move(log))),
      thread_(start_without_signals(core_)) {
  // nop
}

io_thread::~io_thread() {
  stop();
}

void io_thread::post(std::function<void()> task) {
  core_->post(std::move(task));
}

void io_thread::stop() {
  core_->stop();
  if (!thread_.joinable())
    return;
  if (thread_.get_id() == std::this_thread::get_id())
    thread_.detach();
  else
    thread_.join();
}

namespace asio = boost::asio;

/// Lives on the io thread. Asio never owns the descriptor: it is released
/// from the loop before this object ends.
class watched_fd final : public io_component,
                         public std::enable_shared_from_this<watched_fd> {
public:
  watched_fd(std::shared_ptr<io_core> core, shared_fd fd,
             fd_watch::callback on_readable, std::chrono::milliseconds pause)
      : core_(std::move(core)), fd_(std::move(fd)),
        on_readable_(std::move(on_readable)), pause_(pause),
        descriptor_(core_->context()), timer_(core_->context()) {
    // nop
  }

  void start() {
    boost::system::error_code error;
    descriptor_.assign(fd_->get(), error);
    if (error) {
      core_->log("cannot watch a descriptor: " + error.message());
      return;
    }
    core_->adopt(shared_from_this());
    wait();
  }

  void close() {
    on_io_stop();
    core_->release(this);
  }

  void on_io_stop() override {
    timer_.cancel();
    if (descriptor_.is_open())
      descriptor_.release();
    // The callback may hold whoever holds this object.
    on_readable_ = nullptr;
  }

private:
  void wait() {
    descriptor_.async_wait(
        asio::posix::stream_descriptor::wait_read,
        [self = shared_from_this()](const boost::system::error_code& error) {
          if (!error)
            self->on_ready();
        });
  }

  void on_ready() {
    // A copy, because the call may close this object.
    const auto call = on_readable_;
    bool go_on = false;
    core_->guarded([&] { go_on = call && call(); });
    if (!descriptor_.is_open())
      return;
    if (!go_on)
      close();
    else if (pause_.count() > 0)
      rest();
    else
      wait();
  }

  void rest() {
    timer_.expires_after(pause_);
    timer_.async_wait(
        [self = shared_from_this()](const boost::system::error_code& error) {
          if (!error && self->descriptor_.is_open())
            self->wait();
        });
  }

  std::shared_ptr<io_core> core_;
  shared_fd fd_;
  fd_watch::callback on_readable_;
  std::chrono::milliseconds pause_;
  asio::posix::stream_descriptor descriptor_;
  asio::steady_timer timer_;
};

fd_watch::fd_watch(const std::shared_ptr<io_core>& core, shared_fd fd,
                   callback on_readable, std::chrono::milliseconds pause)
    : core_(core), watched_(std::make_shared<watched_fd>(
                       core, std::move(fd), std::move(on_readable), pause)) {
  core_->post([watched = watched_] { watched->start(); });
}

fd_watch& fd_watch::operator=(fd_watch&& other) noexcept {
  if (this != &other) {
    stop();
    core_ = std::move(other.core_);
    watched_ = std::move(other.watched_);
  }
  return *this;
}

fd_watch::~fd_watch() {
  stop();
}

void fd_watch::stop() noexcept {
  if (watched_)
    core_->post([watched = std::move(watched_)] { watched->close(); });
  watched_ = nullptr;
}

} // namespace roscell
