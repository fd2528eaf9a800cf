#include "actors/edge/session/session_dialog.hpp"

#include "actors/edge/io/node_time.hpp"
#include "actors/edge/trust/site_identity.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>

#include <charconv>
#include <cstdlib>
#include <string>
#include <utility>

namespace roscell {

namespace ws = boost::beast::websocket;

namespace {

/// Where each side says its time, in milliseconds since 1970. Peers of earlier
/// versions say and hear nothing.
constexpr const char* time_header = "Roscell-Time";
/// What an age tells.
constexpr int64_t noticed_ms = 2000;
/// The year 9999.
constexpr int64_t latest_time_ms = 253'402'300'799'000;

/// Its joiners fetch a newer list of the revoked than theirs.
acceptor_identity with_list(const session_acceptor& x) {
  auto result = x.identity;
  if (const auto& own = x.site.identity())
    if (const auto list = own->trust().site.revoked)
      result.revocations = list->number();
  return result;
}

} // namespace

session_dialog::session_dialog(std::shared_ptr<io_core> core,
                               link_socket socket, session_options options)
    : core_(std::move(core)), options_(std::move(options)),
      stream_(session_socket{std::move(socket)}), timer_(core_->context()) {
  stream_.next_layer().linger_time = options_.close_timeout;
  stream_.read_message_max(session_frame_bounds::frame);
  stream_.text(true);
  stream_.set_option(ws::stream_base::decorator([](auto& message) {
    message.set(time_header, std::to_string(node_time_ms()));
  }));
}

std::string session_dialog::shared_secret() {
  const auto* tls = stream_.next_layer().tls();
  return tls == nullptr ? std::string{}
                        : to_hex(tls->exported("EXPORTER-roscell-session"));
}

std::optional<edge_error> session_dialog::refusal() {
  const auto why = stream_.next_layer().refusal();
  if (!why)
    return std::nullopt;
  return edge_error{error_code::unauthorized,
                    "the identity of this node was refused: " + why->text,
                    "the events of the other node say why; `roscell site list` "
                    "shows which identities count"};
}

std::optional<identity> session_dialog::proved_peer() {
  const auto* tls = stream_.next_layer().tls();
  return tls == nullptr ? std::nullopt : tls->peer();
}

std::optional<edge_error> mismatch(const identity& proved,
                                   const std::string& node,
                                   const std::string& uuid) {
  const bool is_machine =
      proved.role == site_role::node || proved.role == site_role::coordinator;
  if (is_machine && proved.name == node && proved.uuid == uuid)
    return std::nullopt;
  return edge_error{error_code::unauthorized,
                    "who calls itself node '" + node + "' with UUID " + uuid
                        + " has the identity of " + text_of(proved)
                        + " with UUID " + proved.uuid,
                    "`roscell site issue` makes one for it"};
}

void session_dialog::hear_time(const boost::beast::http::fields& said) {
  const auto text = said[time_header];
  int64_t of_peer = 0;
  const auto [rest, ec] = std::from_chars(text.begin(), text.end(), of_peer);
  // What is no time says nothing.
  if (ec != std::errc{} || rest != text.end() || of_peer <= 0
      || of_peer > latest_time_ms)
    return;
  const auto ahead = node_time_ms() - of_peer;
  ahead_ms_ = std::abs(ahead) < noticed_ms ? 0 : ahead;
}

void session_dialog::begin() {
  core_->adopt(shared_from_this());
  timer_.expires_after(options_.handshake_timeout);
  timer_.async_wait([self = shared_from_this()](error ec) {
    if (!ec)
      self->abort("the handshake of the session took too long");
  });
}

void session_dialog::exchange(std::string first) {
  handshake_step step;
  step.reply = std::move(first);
  take(std::move(step));
}

void session_dialog::read() {
  stream_.async_read(incoming_, [self = shared_from_this()](error ec, size_t) {
    self->on_read(ec);
  });
}

void session_dialog::on_read(error ec) {
  if (over())
    return;
  if (ec)
    return fail_with(ec);
  const auto frame = boost::beast::buffers_to_string(incoming_.data());
  incoming_.consume(incoming_.size());
  take(receive(frame));
}

void session_dialog::take(handshake_step step) {
  if (step.reply.empty())
    return conclude(step);
  outgoing_ = std::move(step.reply);
  step.reply.clear();
  stream_.async_write(boost::asio::buffer(outgoing_),
                      [self = shared_from_this(), step](error ec, size_t) {
                        if (self->over())
                          return;
                        if (ec && !step.failure)
                          return self->fail_with(ec);
                        self->conclude(step);
                      });
}

void session_dialog::conclude(const handshake_step& step) {
  if (step.failure)
    return refuse_peer(*step.failure);
  if (!step.done)
    return read();
  if (!report_once())
    return;
  timer_.cancel();
  const auto self = shared_from_this();
  core_->release(this);
  on_established(std::move(stream_));
}

void session_dialog::fail_with(error ec) {
  if (auto why = refusal())
    return fail(*why);
  if (ec == ws::error::closed)
    return fail({error_code::unreachable,
                 "the peer closed the session during the handshake", ""});
  if (ec == ws::error::message_too_big)
    return fail({error_code::malformed_json,
                 "a frame of the handshake is too large", ""});
  fail({error_code::unreachable,
        "the connection broke during the handshake: " + ec.message(), ""});
}

void session_dialog::refuse_peer(const edge_error& why) {
  if (!report_once())
    return;
  const auto self = shared_from_this();
  core_->guarded([&] { on_refused(why); });
  timer_.expires_after(options_.close_timeout);
  timer_.async_wait([self](error ec) {
    if (!ec)
      close_now(self->stream_.next_layer());
  });
  stream_.async_close(ws::close_code::policy_error, [self](error) {
    self->timer_.cancel();
    close_now(self->stream_.next_layer());
    self->core_->release(self.get());
  });
}

void session_dialog::fail(const edge_error& why) {
  if (!report_once())
    return;
  const auto self = shared_from_this();
  timer_.cancel();
  close_now(stream_.next_layer());
  core_->release(this);
  core_->guarded([&] { on_refused(why); });
}

void session_dialog::abort(const std::string& why) {
  fail({error_code::timeout, why, ""});
}

void session_dialog::on_io_stop() {
  fail({error_code::unreachable, "the io thread stopped", ""});
  close_now(stream_.next_layer());
}

bool session_dialog::report_once() {
  return !std::exchange(reported_, true);
}

session_accept::session_accept(std::shared_ptr<io_core> core,
                               link_socket socket,
                               std::shared_ptr<const session_acceptor> acceptor,
                               hooks reported)
    : session_dialog(std::move(core), std::move(socket), acceptor->options),
      acceptor_(std::move(acceptor)), hooks_(std::move(reported)),
      peer_(peer_of(stream().next_layer().bare())),
      handshake_(with_list(*acceptor_),
                 proved_peer() ? shared_secret() : acceptor_->site.text()) {
  tune_for_session(stream().next_layer().bare(), options().user_timeout);
}

void session_accept::run(upgrade_request request) {
  request_ = std::move(request);
  hear_time(request_);
  begin();
  stream().async_accept(request_, [self = self_as<session_accept>()](error ec) {
    if (self->over())
      return;
    if (ec)
      self->fail({error_code::schema_violation,
                  "the request for a WebSocket is "
                  "invalid: "
                      + ec.message(),
                  ""});
    else
      self->exchange({});
  });
}

handshake_step session_accept::receive(std::string_view frame) {
  auto step = handshake_.receive(frame);
  const auto who = proved_peer();
  if (step.failure || !who)
    return step;
  const auto& said = handshake_.peer();
  auto why = mismatch(*who, said.node, said.uuid);
  if (!why && said.role == coordinator_role
      && who->role != site_role::coordinator)
    why = edge_error{error_code::unauthorized,
                     text_of(*who) + " coordinates no cell, by its identity",
                     "`roscell site issue coordinator` makes one that does"};
  if (why)
    return {encode(*why), false, why};
  return step;
}

void session_accept::on_established(websocket&& stream) {
  const auto& hello = handshake_.peer();
  established_session session;
  session.peer = {hello.node, hello.uuid, hello.version, peer_.address,
                  peer_.port, "",         hello.epoch,   hello.role};
  session.agreement = handshake_.agreement();
  session.ahead_ms = ahead_ms();
  hooks_.on_decided(true);
  session.link = websocket_link::make(core(), std::move(stream), options(),
                                      std::move(hooks_.on_gone));
  if (acceptor_->on_session)
    core()->guarded([&] { acceptor_->on_session(std::move(session)); });
}

void session_accept::on_refused(const edge_error& why) {
  hooks_.on_decided(false);
  if (acceptor_->on_refused)
    acceptor_->on_refused(peer_.address, why);
}

} // namespace roscell
