#include "actors/edge/http/http_target.hpp"
#include "actors/edge/http/http_types.hpp"
#include "actors/edge/session/session_dialog.hpp"

#include <boost/asio/ip/tcp.hpp>
#include <nlohmann/json.hpp>

#include <utility>

namespace roscell {

namespace {

namespace ip = boost::asio::ip;
namespace ws = boost::beast::websocket;

std::string name_of(const session_target& target) {
  return target.address + ":" + std::to_string(target.port);
}

/// The joiner's side, from the TCP connection on.
class session_connect : public session_dialog {
public:
  session_connect(std::shared_ptr<io_core> core, session_target target,
                  joiner_identity identity, const site_secret& site,
                  session_options options,
                  std::function<void(session_result)> callback)
      : session_dialog(core, link_socket{core}, std::move(options)),
        target_(std::move(target)), callback_(std::move(callback)),
        own_(std::move(identity)), site_(site) {}

  void run() {
    begin();
    boost::system::error_code ec;
    const auto address = ip::make_address_v4(target_.address, ec);
    if (ec)
      return fail({error_code::unreachable,
                   "'" + target_.address + "' is not an IPv4 address", ""});
    open_tcp(stream().next_layer().bare());
    stream().next_layer().bare().async_connect(
        ip::tcp::endpoint{address, target_.port},
        [self = self_as<session_connect>()](error connect_ec) {
          if (!self->over())
            self->on_connected(connect_ec);
        });
  }

protected:
  handshake_step receive(std::string_view frame) override {
    auto step = handshake_->receive(frame);
    const auto who = proved_peer();
    if (step.failure || !who)
      return step;
    const auto& said = handshake_->peer();
    if (auto why = mismatch(*who, said.node, said.uuid))
      return {encode(*why), false, why};
    return step;
  }

  void on_established(websocket&& stream) override {
    const auto& challenge = handshake_->peer();
    established_session session;
    session.peer = {challenge.node,       challenge.uuid, challenge.version,
                    target_.address,      target_.port,   challenge.cell,
                    challenge.incarnation};
    session.agreement = handshake_->agreement();
    session.ahead_ms = ahead_ms();
    session.link =
        websocket_link::make(core(), std::move(stream), options(), {});
    core()->guarded([&] { callback_(std::move(session)); });
  }

  void on_refused(const edge_error& why) override {
    callback_(why);
  }

private:
  void on_connected(error ec) {
    if (ec)
      return fail(
          {error_code::unreachable,
           "cannot connect to " + name_of(target_) + ": " + ec.message(), ""});
    tune_for_session(stream().next_layer().bare(), options().user_timeout);
    const auto identity = site_.identity();
    if (!identity)
      return upgrade(site_.text());
    stream().next_layer().secure(
        identity, tls_engine::role::connects,
        [self = self_as<session_connect>()](const auto& why) {
          if (!self->over())
            self->on_secured(why);
        });
  }

  void on_secured(const std::optional<distrusted>& why) {
    const auto who = proved_peer();
    if (!why && who && who->role == site_role::coordinator)
      return upgrade(shared_secret());
    fail({error_code::unauthorized,
          name_of(target_) + " is not believed: "
              + (why   ? why->text
                 : who ? text_of(*who) + " is no coordinator"
                       : "it shows no certificate"),
          why ? why->hint : std::string{}});
  }

  /// @param secret which both ends know.
  void upgrade(const std::string& secret) {
    handshake_.emplace(own_, secret, target_.expected_cell);
    handshake_->expect_uuid(target_.expected_uuid);
    stream().async_handshake(
        response_, name_of(target_), std::string{session_path},
        [self = self_as<session_connect>()](error upgrade_ec) {
          if (!self->over())
            self->on_upgraded(upgrade_ec);
        });
  }

  void on_upgraded(error ec) {
    if (!ec) {
      hear_time(response_);
      return exchange(handshake_->hello());
    }
    if (auto why = refusal())
      return fail(*why);
    if (ec == ws::error::upgrade_declined)
      return fail(declined());
    if (ec == boost::beast::http::error::end_of_stream
        && stream().next_layer().tls() == nullptr)
      return fail({error_code::unreachable,
                   name_of(target_)
                       + " ends the connection without a word, as a site of "
                         "identities does to who has a token: `roscell site "
                         "invite` lets a node in",
                   ""});
    fail({error_code::unreachable,
          name_of(target_) + " does not answer as a node: " + ec.message(),
          ""});
  }

  /// The error in the body of an HTTP answer.
  edge_error declined() const {
    auto decoded = decode_frame<session_accepted>(response_.body());
    if (const auto* why = std::get_if<edge_error>(&decoded);
        why != nullptr && why->code != error_code::malformed_json
        && why->code != error_code::schema_violation)
      return *why;
    return {error_code::conflict,
            name_of(target_) + " takes no sessions (HTTP status "
                + std::to_string(response_.result_int()) + ")",
            ""};
  }

  session_target target_;
  std::function<void(session_result)> callback_;
  const joiner_identity own_;
  const site_secret site_;
  std::optional<joiner_handshake> handshake_; ///< Once there is a secret.
  ws::response_type response_;
};

/// Who is asked for a proof only: it proves itself first, and is then told that
/// there will be no session.
class proof_question : public session_connect {
public:
  proof_question(std::shared_ptr<io_core> core, session_target target,
                 joiner_identity identity, const site_secret& site,
                 session_options options,
                 std::function<void(std::optional<edge_error>)> callback)
      : session_connect(std::move(core), std::move(target), std::move(identity),
                        site, std::move(options), {}),
        on_progress_(std::move(callback)) {}

protected:
  handshake_step receive(std::string_view frame) override {
    auto step = session_connect::receive(frame);
    if (step.failure)
      return step;
    proven_ = true;
    edge_error thanks{error_code::conflict,
                      "it asked for a proof of the site token only", ""};
    return {encode(thanks), false, std::move(thanks)};
  }

  void on_refused(const edge_error& why) override {
    on_progress_(proven_ ? std::nullopt : std::optional{why});
  }

private:
  std::function<void(std::optional<edge_error>)> on_progress_;
  bool proven_ = false;
};

} // namespace

void connect_session(io_thread& io, session_target target,
                     joiner_identity identity, const site_secret& site,
                     session_options options,
                     std::function<void(session_result)> callback) {
  const auto& core = io.core();
  auto joiner = std::make_shared<session_connect>(
      core, std::move(target), std::move(identity), site, std::move(options),
      std::move(callback));
  core->post([joiner] { joiner->run(); });
}

void ask_for_proof(io_thread& io, session_target target,
                   joiner_identity identity, const site_secret& site,
                   session_options options,
                   std::function<void(std::optional<edge_error>)> callback) {
  const auto& core = io.core();
  auto question = std::make_shared<proof_question>(
      core, std::move(target), std::move(identity), site, std::move(options),
      std::move(callback));
  core->post([question] { question->run(); });
}

} // namespace roscell
