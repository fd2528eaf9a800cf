#include "actors/edge/session/websocket_link.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

namespace ws = boost::beast::websocket;

/// A buffer that once held a large frame is given back.
constexpr size_t kept_buffer_bytes = 16 * 1024;

/// What fits into a close frame, as ASCII so that no character is cut.
std::string close_text(const std::string& reason) {
  auto text = reason.substr(0, 120);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < 0x20 || c > 0x7e; },
      '?');
  return text;
}

/// Tells the link once that a frame is done: when called, or at the latest
/// when the last copy of the callback is gone.
class done_token {
public:
  done_token(std::shared_ptr<io_core> core, std::weak_ptr<websocket_link> link)
      : core_(std::move(core)), link_(std::move(link)) {
    // nop
  }

  done_token(const done_token&) = delete;
  done_token& operator=(const done_token&) = delete;

  ~done_token() {
    notify();
  }

  void notify() {
    if (reported_.exchange(true))
      return;
    core_->post([link = link_] {
      if (const auto alive = link.lock())
        alive->on_frame_done();
    });
  }

private:
  std::shared_ptr<io_core> core_;
  std::weak_ptr<websocket_link> link_;
  std::atomic<bool> reported_{false};
};

/// What the owner of a session holds.
class websocket_link_handle : public session_link {
public:
  websocket_link_handle(std::shared_ptr<io_core> core,
                        std::shared_ptr<websocket_link> link)
      : core_(std::move(core)), link_(std::move(link)) {
    // nop
  }

  ~websocket_link_handle() override {
    link_->close("the owner let go of the session");
  }

  void start(session_callbacks callbacks) override {
    core_->post([link = link_, callbacks = std::move(callbacks)]() mutable {
      link->start(std::move(callbacks));
    });
  }

  bool send(std::string text) override {
    return link_->send(std::move(text));
  }

  void close(std::string reason) override {
    link_->close(std::move(reason));
  }

  size_t queued_bytes() const override {
    return link_->queued_bytes();
  }

private:
  std::shared_ptr<io_core> core_;
  std::shared_ptr<websocket_link> link_;
};

} // namespace

websocket_link::websocket_link(std::shared_ptr<io_core> core,
                               websocket&& stream, session_options options,
                               std::function<void()> on_gone)
    : core_(std::move(core)), stream_(std::move(stream)),
      options_(std::move(options)), on_gone_(std::move(on_gone)),
      close_timer_(core_->context()) {
  stream_.read_message_max(options_.max_frame_bytes);
  stream_.auto_fragment(false);
  stream_.text(true);
}

std::shared_ptr<session_link>
websocket_link::make(std::shared_ptr<io_core> core, websocket&& stream,
                     session_options options, std::function<void()> on_gone) {
  auto link = std::make_shared<websocket_link>(
      core, std::move(stream), std::move(options), std::move(on_gone));
  core->adopt(link);
  return std::make_shared<websocket_link_handle>(std::move(core),
                                                 std::move(link));
}

void websocket_link::start(session_callbacks callbacks) {
  if (std::exchange(started_, true))
    return;
  callbacks_ = std::move(callbacks);
  if (ended_)
    report_end();
  else
    read_next();
}

bool websocket_link::send(std::string text) {
  if (!open_ || text.size() > options_.max_frame_bytes)
    return false;
  const auto size = text.size();
  if (queued_bytes_.fetch_add(size) + size > options_.max_queue_bytes) {
    queued_bytes_ -= size;
    open_ = false;
    core_->post([self = shared_from_this()] {
      self->finish({session_end::cause::too_slow, "the peer is too slow"});
    });
    return false;
  }
  core_->post([self = shared_from_this(), text = std::move(text)]() mutable {
    self->queued_bytes_ -= text.size();
    self->filter(traffic_direction::outgoing, std::move(text),
                 &websocket_link::enqueue);
  });
  return true;
}

void websocket_link::enqueue(std::string text) {
  if (closing_ || ended_)
    return;
  queued_bytes_ += text.size();
  outgoing_.push_back(std::move(text));
  write_next();
}

void websocket_link::write_next() {
  if (writing_ || ended_ || close_frame_sent_)
    return;
  if (outgoing_.empty()) {
    if (closing_)
      send_close_frame();
    return;
  }
  writing_ = true;
  stream_.async_write(
      boost::asio::buffer(outgoing_.front()),
      [self = shared_from_this()](error ec, size_t) { self->on_written(ec); });
}

void websocket_link::on_written(error ec) {
  writing_ = false;
  queued_bytes_ -= outgoing_.front().size();
  outgoing_.pop_front();
  if (ended_)
    return outgoing_.clear();
  if (!ec)
    return write_next();
  // A pending read knows better why: the peer may have said so. It gets a
  // moment to tell.
  open_ = false;
  finish_later(closing_.value_or(end_of(ec)));
}

void websocket_link::read_next() {
  if (reading_ || !started_ || closing_ || ended_
      || undone_ >= options_.max_undone_frames)
    return;
  reading_ = true;
  stream_.async_read(incoming_, [self = shared_from_this()](error ec, size_t) {
    self->on_read(ec);
  });
}

void websocket_link::on_read(error ec) {
  reading_ = false;
  if (ended_)
    return;
  if (ec) {
    // While this side closes, the close operation reports the end.
    if (!closing_ || !close_frame_sent_)
      finish(end_of(ec));
    return;
  }
  if (!stream_.got_text())
    return close_soon({session_end::cause::violation, "a binary frame came"});
  auto text = boost::beast::buffers_to_string(incoming_.data());
  incoming_.consume(incoming_.size());
  if (incoming_.capacity() > kept_buffer_bytes)
    incoming_.shrink_to_fit();
  ++undone_;
  filter(traffic_direction::incoming, std::move(text),
         &websocket_link::deliver);
  on_frame_done();
}

void websocket_link::deliver(std::string text) {
  if (closing_ || ended_ || !callbacks_.on_frame)
    return;
  ++undone_;
  auto token = std::make_shared<done_token>(core_, weak_from_this());
  core_->guarded([&] {
    callbacks_.on_frame(std::move(text),
                        [token = std::move(token)] { token->notify(); });
  });
}

void websocket_link::on_frame_done() {
  --undone_;
  read_next();
}

void websocket_link::filter(traffic_direction direction, std::string text,
                            frame_action action) {
  using what = traffic_verdict::action;
  traffic_verdict verdict;
  if (options_.filter)
    core_->guarded([&] { verdict = options_.filter(direction, text); });
  switch (verdict.what) {
  case what::pass:
    return (this->*action)(std::move(text));
  case what::drop:
    return;
  case what::delay:
    return act_later(verdict.delay, std::move(text), action);
  case what::repeat:
    for (unsigned i = 0; i < verdict.times; ++i)
      (this->*action)(text);
    return;
  case what::cut:
    return finish({session_end::cause::lost, "a test cut the connection"});
  }
}

void websocket_link::act_later(std::chrono::milliseconds delay,
                               std::string text, frame_action action) {
  auto timer =
      std::make_shared<boost::asio::steady_timer>(core_->context(), delay);
  timer->async_wait([self = shared_from_this(), timer, action,
                     text = std::move(text)](error) mutable {
    ((*self).*action)(std::move(text));
  });
}

session_end websocket_link::end_of(error ec) const {
  using cause = session_end::cause;
  const auto& said = stream_.reason();
  if (ec == ws::error::closed || said) {
    std::string reason{said.reason.data(), said.reason.size()};
    const bool clean = said.code == ws::close_code::normal
                       || said.code == ws::close_code::going_away
                       || said.code == ws::close_code::none;
    if (reason.empty())
      reason = clean ? "the peer closed the session"
                     : "the peer closed the session with code "
                           + std::to_string(said.code);
    return {cause::closed_there, reason};
  }
  if (ec == ws::error::message_too_big)
    return {cause::violation, "a frame of more than "
                                  + std::to_string(options_.max_frame_bytes)
                                  + " bytes came"};
  if (ec.category() == make_error_code(ws::error::closed).category())
    return {cause::violation, ec.message()};
  return {cause::lost, "the connection broke: " + ec.message()};
}

void websocket_link::close(std::string reason) {
  open_ = false;
  core_->post([self = shared_from_this(), reason = std::move(reason)] {
    self->close_soon({session_end::cause::closed_here, reason});
  });
}

void websocket_link::close_soon(session_end end) {
  if (closing_ || ended_)
    return;
  open_ = false;
  closing_ = std::move(end);
  finish_later(*closing_);
  write_next();
}

void websocket_link::finish_later(session_end end) {
  close_timer_.expires_after(options_.close_timeout);
  close_timer_.async_wait(
      [self = shared_from_this(), end = std::move(end)](error ec) {
        if (!ec)
          self->finish(end);
      });
}

void websocket_link::send_close_frame() {
  close_frame_sent_ = true;
  const auto code = closing_->why == session_end::cause::violation
                        ? ws::close_code::policy_error
                        : ws::close_code::normal;
  stream_.async_close(
      {code, close_text(closing_->reason)},
      [self = shared_from_this()](error) { self->finish(*self->closing_); });
}

void websocket_link::on_io_stop() {
  finish(closing_.value_or(
      session_end{session_end::cause::closed_here, "the io thread stopped"}));
}

void websocket_link::finish(session_end end) {
  if (ended_)
    return;
  ended_ = std::move(end);
  open_ = false;
  close_timer_.cancel();
  close_now(stream_.next_layer());
  core_->release(this);
  if (on_gone_)
    core_->guarded(std::exchange(on_gone_, nullptr));
  if (started_)
    report_end();
}

void websocket_link::report_end() {
  // The callbacks may hold the link; letting go of them breaks the circle.
  const auto callbacks = std::exchange(callbacks_, {});
  if (callbacks.on_closed)
    core_->guarded([&] { callbacks.on_closed(*ended_); });
}

} // namespace roscell
