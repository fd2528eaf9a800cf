#include "actors/edge/exec/engine_channel.hpp"

#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/engine/engine_json.hpp"
#include "actors/edge/exec/channel_handle.hpp"
#include "actors/edge/exec/engine_frames.hpp"
#include "actors/edge/exec/limits.hpp"
#include "actors/edge/exec/upgraded_connection.hpp"

#include <boost/asio/steady_timer.hpp>

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
        timer_(core_->context()) {
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
    const bool ends = last && !what_.order.terminal;
    stream_->write(std::move(bytes), [this, ends](bool good) {
      if (ends || !good)
        stream_->end_input();
      call(calls_.on_input_taken);
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
    if (!over_ && stream_ && !owed_[0] && !owed_[1])
      stream_->read();
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
    const auto prefix = what_.api.empty() ? "" : "/v" + what_.api;
    stream_ = std::make_shared<upgraded_connection>(core_, stream_calls());
    stream_->open(
        what_.socket, prefix + "/exec/" + id_ + "/start",
        json{{"Detach", false}, {"Tty", what_.order.terminal}}.dump());
  }

  /// They are called as long as this lives: it closes the stream.
  upgraded_connection::callbacks stream_calls() {
    upgraded_connection::callbacks result;
    result.on_open = [this] {
      timer_.cancel();
      call(calls_.on_started);
      resize(what_.order.size);
    };
    result.on_bytes = [this](std::string_view bytes) { pass_on(bytes); };
    result.on_end = [this](int status, std::string text) {
      on_stream_end(status, std::move(text));
    };
    return result;
  }

  void on_stream_end(int status, std::string text) {
    if (over_)
      return;
    if (status != 0)
      return fail(
          engine_refusal("the engine refuses it", {status, std::move(text)})
              .message);
    if (!text.empty())
      return fail("the engine cannot be reached: " + text);
    ask_for_end();
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
      return stream_->read();
    for (const bool of_errors : {false, true})
      if (auto& x = outputs[of_errors ? 1 : 0]; !x.empty())
        call(calls_.on_output, of_errors, std::move(x));
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
    if (stream_)
      stream_->close();
    core_->release(this);
  }

  std::shared_ptr<io_core> core_;
  engine_command what_;
  exec_callbacks calls_;
  engine_client client_;
  std::shared_ptr<upgraded_connection> stream_;
  asio::steady_timer timer_;
  engine_frames frames_;
  std::string id_; ///< Of the command, as the engine calls it.
  std::string reason_;
  bool owed_[2] = {false, false}; ///< Outputs that are to be read on first.
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
