#include "actors/edge/http/client/site_door.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/trust/limits.hpp"
#include "actors/edge/trust/sealed_text.hpp"
#include "actors/edge/trust/tls_engine.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/site.hpp"
#include "schemas/document.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include <array>
#include <chrono>
#include <utility>

namespace roscell {

namespace {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;
using door_error = boost::system::error_code;

constexpr std::chrono::seconds door_limit{10};
constexpr size_t door_read_bytes = 16 * 1024;
constexpr const char* entry_target = "/v1/site/entry";

/// One connection by TLS of somebody who has no identity yet, and waits.
class door_connection {
public:
  door_connection()
      : settings_(tls_settings::of_newcomer()),
        tls_(settings_, tls_engine::role::connects, entry_protocol),
        socket_(loop_) {
    // nop
  }

  bool open(const socket_address& to) {
    socket_.async_connect({asio::ip::make_address_v4(to.address), to.port},
                          [this](door_error ec) { done(ec, 0); });
    return wait() && shake_hands();
  }

  /// Sends it, and reads until the other end has nothing more to say.
  bool exchange(const std::string& text, std::string& reply) {
    tls_.write(text);
    if (!send())
      return false;
    while (reply.size() <= limits::trust::admission_bytes) {
      const auto more = tls_.read(door_read_bytes);
      reply += more;
      if (tls_.has_ended() || tls_.problem())
        return tls_.has_ended();
      if (more.empty() && !receive())
        return false;
    }
    problem_ = "it sends more than an admission can be";
    return false;
  }

  const tls_engine& tls() const {
    return tls_;
  }

  std::string problem() const {
    return tls_.problem() ? tls_.problem()->text : problem_;
  }

private:
  bool shake_hands() {
    if (!send())
      return false;
    while (!tls_.is_open() && !tls_.problem())
      if (!receive() || !send())
        return false;
    return tls_.is_open();
  }

  bool send() {
    const auto bytes = tls_.give();
    if (bytes.empty())
      return true;
    asio::async_write(socket_, asio::buffer(bytes),
                      [this](door_error ec, size_t n) { done(ec, n); });
    return wait();
  }

  bool receive() {
    socket_.async_read_some(asio::buffer(room_),
                            [this](door_error ec, size_t n) { done(ec, n); });
    if (!wait())
      return false;
    tls_.take({room_.data(), size_});
    return true;
  }

  void done(door_error ec, size_t size) {
    settled_ = true;
    outcome_ = ec;
    size_ = size;
  }

  /// For what was begun.
  bool wait() {
    settled_ = false;
    loop_.restart();
    while (!settled_ && loop_.run_one_until(until_) > 0) {
    }
    if (!settled_) {
      problem_ = "it does not answer in time";
      door_error ignored;
      socket_.close(ignored);
      loop_.poll(); // What was begun uses this.
      return false;
    }
    if (outcome_)
      problem_ = outcome_.message();
    return !outcome_;
  }

  tls_settings settings_;
  tls_engine tls_;
  asio::io_context loop_;
  tcp::socket socket_;
  std::chrono::steady_clock::time_point until_ =
      std::chrono::steady_clock::now() + door_limit;
  std::array<char, door_read_bytes> room_{};
  std::string problem_;
  door_error outcome_;
  size_t size_ = 0;
  bool settled_ = false;
};

edge_error door_refusal(error_code code, const std::string& address,
                        const std::string& why, const std::string& hint = {}) {
  return {code, "at " + address + ": " + why, hint};
}

std::string request_of(const std::string& host, const std::string& body) {
  return std::string{"POST "} + entry_target + " HTTP/1.1\r\nHost: " + host
         + "\r\nUser-Agent: roscell\r\nConnection: close\r\n"
           "Content-Type: application/json\r\nContent-Length: "
         + std::to_string(body.size()) + "\r\n\r\n" + body;
}

/// The document in a whole reply.
edge_result<site_entered> read_reply(const std::string& address,
                                     const std::string& text) {
  namespace http = boost::beast::http;
  http::response_parser<http::string_body> parser;
  parser.eager(true);
  parser.body_limit(limits::trust::admission_bytes);
  door_error ec;
  parser.put(asio::buffer(text), ec);
  if (!parser.is_done())
    return door_refusal(error_code::schema_violation, address,
                        "what answers is no node of ROSCell");
  auto parsed = parse_document(parser.get().body());
  const auto* document = std::get_if<json>(&parsed);
  if (document == nullptr || !document->is_object())
    return door_refusal(error_code::schema_violation, address,
                        "what it says is no document");
  if (parser.get().result_int() != 200) {
    const auto why = document->value("error", json::object());
    return door_refusal(error_code_from(why.value("code", "")), address,
                        why.value("message", ""), why.value("hint", ""));
  }
  auto entered = decode<site_entered>(*document);
  if (const auto* why = std::get_if<failure>(&entered))
    return door_refusal(error_code::schema_violation, address, why->message);
  return std::get<site_entered>(std::move(entered));
}

/// All of it for him who has the secret.
edge_result<kept_identity> open_deposit(const invitation& by,
                                        const std::string& address,
                                        const std::string& deposit) {
  const auto spoiled = door_refusal(error_code::schema_violation, address,
                                    "what was kept for this invitation cannot "
                                    "be opened",
                                    "ask for another invitation");
  const auto sealed = from_hex(deposit);
  const auto text = sealed ? open_sealed(by.secret, *sealed) : std::nullopt;
  auto parsed = parse_document(text.value_or(""));
  const auto* document = std::get_if<json>(&parsed);
  if (document == nullptr || !document->is_object())
    return spoiled;
  auto own = read_identity(document->value("own", ""));
  if (const auto* why = std::get_if<edge_error>(&own))
    return *why;
  return kept_identity{std::get<own_identity>(std::move(own)),
                       document->value("issuing", ""),
                       {}};
}

/// Of a key that has never left this machine.
edge_result<kept_identity> take_certificate(const std::string& address,
                                            const private_key& key,
                                            const site_entered& got) {
  auto own = read_identity(key.pem() + got.chain + got.site);
  if (const auto* why = std::get_if<edge_error>(&own))
    return door_refusal(why->code, address, why->message, why->hint);
  return kept_identity{std::get<own_identity>(std::move(own)), {}, {}};
}

/// Whoever answers is to be of the site that was meant, and a coordinator.
std::optional<edge_error> check_host(const invitation& by,
                                     const std::string& address,
                                     const site_entered& got,
                                     const std::vector<certificate>& shown) {
  const auto foreign = [&](const std::string& why) {
    return door_refusal(error_code::unauthorized, address, why,
                        "somebody else may be at that address: do not use the "
                        "invitation there again");
  };
  const auto site = certificates_in(got.site, 1);
  if (!site || site->size() != 1 || site->front().site() != by.site
      || !speaks_of(by, site->front().digest()))
    return foreign("it is not of the site '" + by.site
                   + "' that the invitation speaks of");
  // What a clock says that was never set is not to be believed here.
  const auto when = shown.empty() ? 0 : shown.front().begins_unix_s();
  const auto who =
      check_chain({site->front(), nullptr}, shown, trusted_now(when, 0, 0));
  if (const auto* why = std::get_if<distrusted>(&who))
    return foreign(why->text);
  if (std::get<identity>(who).role != site_role::coordinator)
    return foreign("it is " + text_of(std::get<identity>(who))
                   + ", and no coordinator");
  return std::nullopt;
}

edge_result<kept_identity> enter_at(const invitation& by,
                                    const std::string& address,
                                    const site_newcomer& who) {
  const auto place = parse_host_address(address);
  if (!place)
    return door_refusal(error_code::unreachable, address, "no such address");
  const auto host = await_host(place->address, door_limit);
  if (const auto* why = std::get_if<edge_error>(&host))
    return *why;
  door_connection connection;
  if (!connection.open({std::get<std::string>(host), place->port}))
    return door_refusal(error_code::unreachable, address, connection.problem(),
                        "a coordinator lets newcomers in while it has an "
                        "invitation that is open");
  const auto key = private_key::make();
  const auto proving = proving_half(by.secret);
  site_entry entry;
  entry.invitation = id_of_invitation(proving);
  entry.proof =
      prove_invitation(proving, connection.tls().exported(invitation_label));
  entry.node = who.name;
  entry.uuid = who.uuid;
  entry.request = to_hex(key.request());
  std::string reply;
  if (!connection.exchange(request_of(address, message_json(entry).dump()),
                           reply)
      || reply.empty())
    return door_refusal(error_code::unreachable, address,
                        "nobody is let in there at present",
                        "the invitation was used, or is over, or its "
                        "coordinator was started anew: `roscell site invite` "
                        "makes another one");
  const auto got = read_reply(address, reply);
  if (const auto* why = std::get_if<edge_error>(&got))
    return *why;
  const auto& entered = std::get<site_entered>(got);
  if (auto why =
          check_host(by, address, entered, connection.tls().peer_chain()))
    return *why;
  auto result = entered.deposit.empty()
                    ? take_certificate(address, key, entered)
                    : open_deposit(by, address, entered.deposit);
  if (auto* admission = std::get_if<kept_identity>(&result))
    admission->revoked = entered.revoked;
  return result;
}

} // namespace

edge_result<kept_identity> enter_site(const invitation& by,
                                      const site_newcomer& who) {
  edge_result<kept_identity> result = edge_error{
      error_code::unreachable, "the invitation names no address", {}};
  for (const auto& address : by.addresses) {
    result = enter_at(by, address, who);
    const auto* why = std::get_if<edge_error>(&result);
    if (why == nullptr || why->code != error_code::unreachable)
      break;
  }
  return result;
}

std::string deposit_of(const kept_identity& x) {
  return json{{"own", text_of(x.own)}, {"issuing", x.issuing}}.dump();
}

} // namespace roscell
