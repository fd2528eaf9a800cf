#include "actors/edge/exec/child_channel.hpp"

#include "actors/edge/exec/channel_handle.hpp"
#include "actors/edge/exec/limits.hpp"
#include "actors/edge/process/process_identity.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

namespace {

namespace asio = boost::asio;

using descriptor = asio::posix::stream_descriptor;
using error = boost::system::error_code;

/// What a terminal takes for the end of its input, at the beginning of a line.
constexpr const char* end_of_input = "\x04";

/// What an exit code has above the number of the signal.
constexpr int signal_base = 128;

/// One output of the program.
struct read_end {
  explicit read_end(asio::io_context& context) : fd(context) {
    // nop
  }

  descriptor fd;
  std::vector<char> buffer;
  bool of_errors = false;
  bool open = false;
  bool reading = false;
};

/// A program and its streams on the io thread.
class child_channel final : public channel_core,
                            public std::enable_shared_from_this<child_channel> {
public:
  child_channel(std::shared_ptr<io_core> core, attached_program program,
                bool terminal, unique_fd instance, exec_callbacks calls)
      : core_(std::move(core)), calls_(std::move(calls)), terminal_(terminal),
        input_(core_->context()), outputs_{read_end{core_->context()},
                                           read_end{core_->context()}},
        child_(core_->context()), instance_(core_->context()),
        patience_(core_->context()), program_(std::move(program)),
        instance_fd_(std::move(instance)) {
    outputs_[1].of_errors = true;
  }

  void run() override {
    core_->adopt(shared_from_this());
    take(input_, program_.input);
    take(child_, program_.pidfd);
    take(instance_, instance_fd_);
    open(outputs_[0], program_.output);
    open(outputs_[1], program_.errors);
    await(child_, [](child_channel& x) { x.on_child_ended(); });
    if (instance_.is_open())
      await(instance_, [](child_channel& x) {
        x.end("the instance has ended");
        x.finish_if_ended();
      });
    call(calls_.on_started);
    read_on(false);
    read_on(true);
  }

  void write(std::string bytes, bool last) override {
    if (over_)
      return;
    if (terminal_ && last)
      bytes += end_of_input;
    writing_ = std::move(bytes);
    if (!input_.is_open())
      return call(calls_.on_input_taken);
    asio::async_write(input_, asio::buffer(writing_),
                      [self = shared_from_this(), last](error ec, size_t) {
                        self->on_written(ec, last);
                      });
  }

  void resize(terminal_size size) override {
    if (!over_ && terminal_)
      resize_terminal(input_.native_handle(), size);
  }

  void read_on(bool of_errors) override {
    auto& x = outputs_[of_errors ? 1 : 0];
    if (over_ || !x.open || std::exchange(x.reading, true))
      return;
    x.buffer.resize(exec_part_bytes);
    x.fd.async_read_some(asio::buffer(x.buffer), [self = shared_from_this(),
                                                  &x](error ec, size_t size) {
      self->on_read(x, ec, size);
    });
  }

  /// The shim kills all that it has started.
  void end(std::string reason) override {
    if (reason_.empty())
      reason_ = std::move(reason);
    program_.lifeline.reset();
  }

  void abandon() override {
    calls_ = {};
    program_.lifeline.reset();
    finish();
  }

  void on_io_stop() override {
    abandon();
  }

private:
  static void take(descriptor& to, unique_fd& from) {
    if (from)
      to.assign(::fcntl(from.get(), F_DUPFD_CLOEXEC, 0));
    from.reset();
  }

  static void open(read_end& to, unique_fd& from) {
    to.open = static_cast<bool>(from);
    take(to.fd, from);
  }

  template <class Function>
  void await(descriptor& fd, Function on_ready) {
    fd.async_wait(descriptor::wait_read,
                  [self = shared_from_this(), on_ready](error ec) {
                    if (!ec && !self->over_)
                      on_ready(*self);
                  });
  }

  template <class Function, class... Args>
  void call(const Function& function, Args&&... args) {
    // A copy: what is called may let go of this.
    const auto copy = function;
    if (copy)
      core_->guarded([&] { copy(std::forward<Args>(args)...); });
  }

  /// A program that reads no more is given nothing, and nobody has to know.
  void on_written(error ec, bool last) {
    if (over_)
      return;
    writing_.clear();
    if ((ec || last) && !terminal_)
      close(input_);
    call(calls_.on_input_taken);
  }

  /// A terminal that nobody has open any more ends by an error.
  void on_read(read_end& x, error ec, size_t size) {
    x.reading = false;
    if (over_)
      return;
    if (ec) {
      x.open = false;
      close(x.fd);
      return finish_if_ended();
    }
    call(calls_.on_output, x.of_errors, std::string{x.buffer.data(), size});
  }

  /// What has escaped the shim may hold the other ends of its streams for ever.
  void on_child_ended() {
    exit_code_ = reap(child_.native_handle()).value_or(0);
    ended_ = true;
    patience_.expires_after(limits::exec::last_output);
    patience_.async_wait([self = shared_from_this()](error ec) {
      if (!ec && !self->over_)
        self->stop_waiting();
    });
    finish_if_ended();
  }

  /// Reads that have found nothing for so long find nothing any more, and of
  /// what was ended nobody wants the rest.
  void stop_waiting() {
    for (auto& x : outputs_)
      if (x.reading) {
        x.fd.cancel();
      } else if (!reason_.empty()) {
        x.open = false;
        close(x.fd);
      }
    is_patient_ = false;
    finish_if_ended();
  }

  void finish_if_ended() {
    if (!ended_ || outputs_[0].open || outputs_[1].open)
      return;
    // What ends an instance kills the command first, where they share a cgroup.
    if (exit_code_ == signal_base + SIGKILL && reason_.empty()
        && instance_.is_open() && is_patient_)
      return;
    const auto on_end = calls_.on_end;
    const auto code = exit_code_;
    const auto reason = reason_;
    finish();
    if (on_end)
      core_->guarded([&] { on_end(code, reason); });
  }

  static void close(descriptor& fd) {
    error ignored;
    fd.close(ignored);
  }

  void finish() {
    if (std::exchange(over_, true))
      return;
    const auto self = shared_from_this();
    patience_.cancel();
    for (auto* x : {&input_, &outputs_[0].fd, &outputs_[1].fd, &instance_})
      close(*x);
    if (ended_)
      close(child_);
    else
      reap_later(self);
    core_->release(this);
  }

  /// Nobody is told any more, but it must not stay in the process table.
  void reap_later(const std::shared_ptr<child_channel>& self) {
    child_.cancel();
    child_.async_wait(descriptor::wait_read, [self](error ec) {
      if (!ec)
        reap(self->child_.native_handle());
    });
  }

  std::shared_ptr<io_core> core_;
  exec_callbacks calls_;
  const bool terminal_;
  descriptor input_;
  std::array<read_end, 2> outputs_;
  descriptor child_;
  descriptor instance_;
  asio::steady_timer patience_;
  attached_program program_;
  unique_fd instance_fd_;
  std::string writing_;
  std::string reason_;
  int exit_code_ = 0;
  bool ended_ = false;     ///< The program has.
  bool is_patient_ = true; ///< Until a moment after that.
  bool over_ = false;
};

} // namespace

std::shared_ptr<exec_channel>
open_child_channel(std::shared_ptr<io_core> core, attached_program program,
                   bool terminal, unique_fd instance, exec_callbacks calls) {
  auto channel =
      std::make_shared<child_channel>(core, std::move(program), terminal,
                                      std::move(instance), std::move(calls));
  return handle_of(std::move(core), std::move(channel));
}

} // namespace roscell
