#include "actors/edge/io/fd_watch.hpp"

#include "actors/edge/io/io_core.hpp"

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include <utility>

namespace roscell {

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
