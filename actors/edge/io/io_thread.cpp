#include "actors/edge/io/io_thread.hpp"

#include "actors/edge/io/io_core.hpp"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>

#include <csignal>
#include <utility>

#include <pthread.h>

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

} // namespace roscell
