#include "actors/edge/http/http_connection.hpp"
#include "actors/edge/http/http_shared.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/http/limits.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/sockets.hpp"
#include "actors/edge/trust/invitation.hpp"

#include <string>
#include <utility>
#include <variant>

/// Who may ask, as far as it is known before the body of a request.
namespace roscell {

namespace {

namespace http = boost::beast::http;

/// Manifests of builds are longer than requests.
size_t body_bytes_for(const std::string& path, const http_limits& limits) {
  constexpr std::string_view ending = "/manifest";
  const bool manifest =
      path.compare(0, builds_path.size(), builds_path) == 0
      && path.size() > ending.size()
      && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
  return manifest ? limits::http::manifest_bytes : limits.body_bytes;
}

} // namespace

/// Checks what can be known before the body. False if that was the end, or
/// something else goes on with it.
bool http_connection::on_header() {
  const auto& request = parser_->get();
  const auto asked = request.target();
  const auto target = parse_target({asked.data(), asked.size()});
  if (!target) {
    refuse_request(400, error_code::schema_violation,
                   "the target is malformed");
    return false;
  }
  if (request.method() != http::verb::get
      && request.method() != http::verb::post) {
    refuse_request(405, error_code::unknown_type,
                   "the method is neither GET nor POST");
    return false;
  }
  if (target->path == session_path && !local_ && !newcomer_) {
    begin_session();
    return false;
  }
  if (local_)
    return admit(target->path);
  if (newcomer_)
    return check_body(shared_->limits.public_body_bytes);
  if (peer_)
    return admit_peer(target->path);
  const auto caller = find_caller(shared_->access, request, target->path,
                                  peer_of(socket_.bare()).address);
  if (const auto* why = std::get_if<http_refusal>(&caller)) {
    refuse_request(why->status, why->code, why->message, why->hint);
    return false;
  }
  if (std::get<http_caller>(caller) == http_caller::unauthenticated_peer)
    return check_body(shared_->limits.public_body_bytes);
  if (std::get<http_caller>(caller) == http_caller::follows_link) {
    lead_on(target->path);
    return false;
  }
  return admit(target->path);
}

/// To the same page, without the secret, which is worth nothing any more. No
/// program of the page reads the cookie, and no other page's request has it.
void http_connection::lead_on(const std::string& path) {
  auto& access = shared_->access;
  access.link_spent = true;
  more_head_ = "\r\nLocation: " + encode_path(access.without_secret(path))
               + "\r\nSet-Cookie: " + access.cookie_name + "="
               + access.cookie_value + "; Path=/; HttpOnly; SameSite=Strict";
  phase_ = phase::answering;
  last_reply_ = true;
  reply({303, "text/plain", ""});
}

/// What he may, the handler knows by his role.
bool http_connection::admit_peer(const std::string& path) {
  const auto& request = parser_->get();
  if (const auto why = refuse_foreign_page(request)) {
    refuse_request(why->status, why->code, why->message, why->hint);
    return false;
  }
  permitted_ = has_permit(shared_->access, request, path,
                          peer_of(socket_.bare()).address);
  return admit(path);
}

/// Whoever asks is trusted with a request.
bool http_connection::admit(const std::string& path) {
  if (!local_ && !shared_->table.promote(this, http_group::trusted)) {
    refuse_crowd();
    return false;
  }
  return check_body(body_bytes_for(path, shared_->limits));
}

/// The reply has the form of one to a request, but none need have been read.
void http_connection::refuse_crowd() {
  if (!parser_)
    parser_.emplace();
  const auto refusal = crowd_error();
  refuse_request(503, refusal.code, refusal.message, refusal.hint);
}

/// "operator anna at 10.0.0.3:40112"
void http_connection::name_caller(http_request& request) {
  const auto at = peer_name(socket_.bare());
  if (newcomer_) {
    request.role = newcomer_role;
    request.from = "newcomer at " + at;
    request.exported = to_hex(socket_.tls()->exported(invitation_label));
    const auto chain = socket_.tls()->peer_chain();
    if (peer_ && !chain.empty())
      request.peer = chain.front().pem();
  } else if (peer_) {
    request.role = to_word(peer_->role);
    request.from = request.role + " " + peer_->name + " at " + at;
  } else if (request.method == "POST") {
    request.from = at;
  }
}

} // namespace roscell
