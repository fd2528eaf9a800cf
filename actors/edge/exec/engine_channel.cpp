#include "actors/edge/exec/engine_channel.hpp"

#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/engine/engine_json.hpp"
#include "actors/edge/exec/channel_handle.hpp"
#include "actors/edge/exec/engine_frames.hpp"
#include "actors/edge/exec/limits.hpp"
#include "actors/edge/io/sockets.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>

#include <algorithm>
#include <array>
#include <csignal>
#include <utility>

namespace roscell {

namespace {

namespace asio = boost::asio;

using error = boost::system::error_code;
using json = nlohmann::json;

constexpr int killed = 128 + SIGKILL;

/// The words that a container was started with: one engine gives a list, the
/// other may give one text.
std::vector<std::string> entry_of(const json& container) {
  const auto config = object_at(container, "Config");
  const auto entry = config.value("Entrypoint", json::array());
  std::vector<std::string> result;
  if (entry.is_array())
    for (const auto& x : entry)
      if (x.is_string())
        result.push_back(x.get<std::string>());
  if (!entry.is_string())
    return result;
  const auto text = entry.get<std::string>();
  for (size_t at = 0; at < text.size();) {
    const auto blank = std::min(text.find(' ', at), text.size());
    result.push_back(text.substr(at, blank - at));
    at = blank + 1;
  }
  return result;
}

/// A command of an engine on the io thread. First the container is looked at,
/// then the command is made and its stream opened; once that has ended, the
/// engine is asked how.
class engine_channel final
    : public channel_core,
      public std::enable_shared_from_this<engine_channel> {
public:
  engine_channel(std::shared_ptr<io_core> core, engine_command what,
                 exec_callbacks calls)
      : core_(std::move(core)), what_(std::move(what)),
        calls_(std::move(calls)), client_(core_, what_.socket, what_.api),
        stream_(core_->context()), timer_(core_->context()) {
    // nop
  }

  void run() override {
    core_->adopt(shared_from_this());
    ask("GET", "/containers/" + what_.order.container + "/json", {},
        [](auto& self, const engine_reply& reply) { self.on_looked(reply); });
  }

  void write(std::string bytes, bool last) override {
    if (over_)
      return;
    if (last && what_.order.terminal)
      bytes += "\x04";
    writing_ = std::move(bytes);
    asio::async_write(stream_, asio::buffer(writing_),
                      [self = shared_from_this(), last](error ec, size_t) {
                        self->on_written(ec, last);
                      });
  }

  /// An engine that cannot do this has told nobody of the size: no harm.
  void resize(terminal_size size) override {
    if (over_ || id_.empty() || size.columns <= 0 || size.rows <= 0)
      return;
    ask("POST",
        "/exec/" + id_ + "/resize?h=" + std::to_string(size.rows)
            + "&w=" + std::to_string(size.columns),
        {}, [](auto&, const engine_reply&) {});
  }

  void read_on(bool of_errors) override {
    owed_[of_errors ? 1 : 0] = false;
    if (!over_ && streams_ && !owed_[0] && !owed_[1])
      read();
  }

  /// The shim ends all that it has started.
  void end(std::string reason) override {
    if (over_)
      return;
    if (reason_.empty())
      reason_ = std::move(reason);
    what_.lifeline.cut();
    after(limits::exec::engine, [](auto& self) { self.conclude(killed); });
  }

  void abandon() override {
    calls_ = {};
    finish();
  }

  void on_io_stop() override {
    abandon();
  }

private:
  using step = void (*)(engine_channel&, const engine_reply&);

  /// An answer that is not good ends all, but for what comes at the end.
  void ask(const char* method, std::string target, const json& body,
           step then) {
    engine_request request;
    request.method = method;
    request.target = std::move(target);
    if (!body.is_null())
      request.body = body.dump(-1, ' ', false, json::error_handler_t::replace);
    request.limit = limits::exec::engine;
    client_.request(std::move(request), [self = shared_from_this(),
                                         then](const engine_answer& answer) {
      if (self->over_)
        return;
      if (const auto* why = std::get_if<edge_error>(&answer))
        self->fail(why->message);
      else
        then(*self, std::get<engine_reply>(answer));
    });
  }

  void on_looked(const engine_reply& reply) {
    const auto container = json::parse(reply.body, nullptr, false);
    if (!reply.ok() || !container.is_object())
      return fail(engine_refusal("its container is not there", reply).message);
    const auto& order = what_.order;
    ask("POST", "/containers/" + order.container + "/exec",
        {{"AttachStdin", true},
         {"AttachStdout", true},
         {"AttachStderr", true},
         {"Tty", order.terminal},
         {"Env", what_.environment},
         {"Cmd", what_.words(entry_of(container))}},
        [](auto& self, const engine_reply& x) { self.on_made(x); });
  }

  void on_made(const engine_reply& reply) {
    id_ = text_at(json::parse(reply.body, nullptr, false), "Id");
    if (!reply.ok() || id_.empty())
      return fail(engine_refusal("the engine refuses it", reply).message);
    after(limits::exec::engine,
          [](auto& self) { self.fail("the engine did not begin it in time"); });
    open_unix(stream_);
    stream_.async_connect(
        asio::local::stream_protocol::endpoint{what_.socket},
        [self = shared_from_this()](error ec) { self->on_connected(ec); });
  }

  void on_connected(error ec) {
    if (over_)
      return;
    if (ec)
      return fail("the engine cannot be reached: " + ec.message());
    const auto body =
        json{{"Detach", false}, {"Tty", what_.order.terminal}}.dump();
    writing_ = "POST " + (what_.api.empty() ? "" : "/v" + what_.api) + "/exec/"
               + id_
               + "/start HTTP/1.1\r\nHost: localhost\r\nUser-Agent: roscell\r\n"
                 "Connection: Upgrade\r\nUpgrade: tcp\r\n"
                 "Content-Type: application/json\r\nContent-Length: "
               + std::to_string(body.size()) + "\r\n\r\n" + body;
    asio::async_write(stream_, asio::buffer(writing_),
                      [self = shared_from_this()](error, size_t) {
                        // What went wrong is seen by reading.
                      });
    read();
  }

  void read() {
    if (std::exchange(reading_, true))
      return;
    buffer_.resize(exec_part_bytes);
    stream_.async_read_some(asio::buffer(buffer_),
                            [self = shared_from_this()](error ec, size_t n) {
                              self->reading_ = false;
                              if (!self->over_)
                                self->on_read(ec, n);
                            });
  }

  void on_read(error ec, size_t size) {
    const std::string_view bytes{buffer_.data(), size};
    if (streams_ && ec)
      return ask_for_end();
    if (streams_)
      return pass_on(bytes);
    head_ += bytes;
    const auto head = read_answer_head(head_);
    if (head.bytes == 0 && !ec && head_.size() < limits::engine::header_bytes)
      return read();
    constexpr int upgraded = 101;
    constexpr int ok = 200;
    if (head.status != upgraded && head.status != ok)
      return fail(head.bytes == 0 ? "the engine's answer cannot be read"
                                  : refusal(head));
    streams_ = true;
    timer_.cancel();
    call(calls_.on_started);
    resize(what_.order.size);
    pass_on(std::string_view{head_}.substr(head.bytes));
  }

  std::string refusal(const engine_answer_head& head) const {
    return engine_refusal("the engine refuses it",
                          {head.status, head_.substr(head.bytes)})
        .message;
  }

  void pass_on(std::string_view bytes) {
    std::array<std::string, 2> outputs;
    if (what_.order.terminal)
      outputs[0] = bytes;
    else if (!frames_.take(bytes, outputs))
      return fail("the engine's stream cannot be read");
    for (const bool of_errors : {false, true})
      owed_[of_errors ? 1 : 0] = !outputs[of_errors ? 1 : 0].empty();
    if (!owed_[0] && !owed_[1])
      return read();
    for (const bool of_errors : {false, true})
      if (auto& x = outputs[of_errors ? 1 : 0]; !x.empty())
        call(calls_.on_output, of_errors, std::move(x));
  }

  void on_written(error ec, bool last) {
    if (over_)
      return;
    writing_.clear();
    error ignored;
    if ((ec || last) && !what_.order.terminal)
      stream_.shutdown(stream_socket::shutdown_send, ignored);
    call(calls_.on_input_taken);
  }

  /// One that has just ended may run still, as its engine sees it.
  void ask_for_end() {
    timer_.cancel();
    ask("GET", "/exec/" + id_ + "/json", {},
        [](auto& self, const engine_reply& x) { self.on_end_reported(x); });
  }

  void on_end_reported(const engine_reply& reply) {
    const auto exec = json::parse(reply.body, nullptr, false);
    if (!reply.ok() || !exec.is_object()) {
      if (reason_.empty())
        reason_ = "the instance has ended";
      return conclude(killed);
    }
    if (flag_at(exec, "Running")) {
      if (++looks_ > limits::exec::most_looks)
        return fail("the engine broke its stream");
      return after(limits::exec::look_again,
                   [](auto& self) { self.ask_for_end(); });
    }
    const auto code = static_cast<int>(number_at(exec, "ExitCode", killed));
    if (code != killed || !reason_.empty())
      return conclude(code);
    looks_ = 0;
    look_after_instance();
  }

  /// What ends a container ends its commands first.
  void look_after_instance() {
    ask("GET", "/containers/" + what_.order.container + "/json", {},
        [](auto& self, const engine_reply& reply) {
          const auto container = json::parse(reply.body, nullptr, false);
          const bool runs =
              reply.ok() && flag_at(object_at(container, "State"), "Running");
          if (!runs)
            self.reason_ = "the instance has ended";
          if (!runs || ++self.looks_ > limits::exec::most_instance_looks)
            return self.conclude(killed);
          self.after(limits::exec::look_again,
                     [](auto& x) { x.look_after_instance(); });
        });
  }

  template <class Function>
  void after(std::chrono::milliseconds time, Function then) {
    timer_.expires_after(time);
    timer_.async_wait([self = shared_from_this(), then](error ec) {
      if (!ec && !self->over_)
        then(*self);
    });
  }

  template <class Function, class... Args>
  void call(const Function& function, Args&&... args) {
    // A copy: what is called may let go of this.
    const auto copy = function;
    if (copy)
      core_->guarded([&] { copy(std::forward<Args>(args)...); });
  }

  void fail(std::string reason) {
    if (reason_.empty())
      reason_ = std::move(reason);
    conclude(killed);
  }

  void conclude(int exit_code) {
    const auto on_end = calls_.on_end;
    const auto reason = reason_;
    finish();
    if (on_end)
      core_->guarded([&] { on_end(exit_code, reason); });
  }

  void finish() {
    if (std::exchange(over_, true))
      return;
    const auto self = shared_from_this();
    what_.lifeline.cut();
    timer_.cancel();
    close_now(stream_);
    core_->release(this);
  }

  std::shared_ptr<io_core> core_;
  engine_command what_;
  exec_callbacks calls_;
  engine_client client_;
  stream_socket stream_;
  asio::steady_timer timer_;
  engine_frames frames_;
  std::vector<char> buffer_;
  std::string id_;   ///< Of the command, as the engine calls it.
  std::string head_; ///< Of the engine's answer, and what came with it.
  std::string writing_;
  std::string reason_;
  bool owed_[2] = {false, false}; ///< Outputs that are to be read on first.
  bool streams_ = false;          ///< The engine has begun it.
  bool reading_ = false;
  bool over_ = false;
  int looks_ = 0;
};

} // namespace

std::shared_ptr<exec_channel> open_engine_channel(std::shared_ptr<io_core> core,
                                                  engine_command what,
                                                  exec_callbacks calls) {
  auto channel =
      std::make_shared<engine_channel>(core, std::move(what), std::move(calls));
  return handle_of(std::move(core), std::move(channel));
}

} // namespace roscell
