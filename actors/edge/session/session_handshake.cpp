#include "actors/edge/session/session_handshake.hpp"

#include "actors/edge/session/proofs.hpp"

#include <utility>

namespace roscell {

namespace {

constexpr std::string_view acceptor_label = "roscell session v1 acceptor";
constexpr std::string_view joiner_label = "roscell session v1 joiner";
constexpr std::string_view session_label = "roscell session v1 id";
constexpr std::string_view acceptor_heartbeat_label =
    "roscell beat v1 acceptor";
constexpr std::string_view joiner_heartbeat_label = "roscell beat v1 joiner";

/// HMAC over the label and all that both sides said.
digest keyed_digest(std::string_view token, std::string_view label,
                    const session_hello& hello,
                    const session_challenge& challenge) {
  transcript said{label};
  said.add(hello.version)
      .add(hello.node)
      .add(hello.uuid)
      .add(hello.epoch)
      .add(hello.nonce)
      .add(challenge.version)
      .add(challenge.node)
      .add(challenge.uuid)
      .add(challenge.cell)
      .add(challenge.incarnation)
      .add(challenge.nonce);
  // Who has no role says the same as before there were any.
  if (!hello.role.empty())
    said.add(hello.role);
  return said.sign(token);
}

std::string session_id(std::string_view token, const session_hello& hello,
                       const session_challenge& challenge) {
  const auto id = to_hex(keyed_digest(token, session_label, hello, challenge));
  return id.substr(0, session_frame_bounds::session);
}

std::string_view major_of(std::string_view version) {
  return version.substr(0, version.find('.'));
}

std::optional<edge_error> check_version(const std::string& node,
                                        const std::string& version) {
  if (major_of(version) == major_of(session_version))
    return std::nullopt;
  return edge_error{error_code::conflict,
                    "the protocol " + version + " of node '" + node
                        + "' and the protocol " + std::string{session_version}
                        + " of its peer do not work together",
                    "install the same major version of ROSCell on both"};
}

/// Both sides read this, and neither can know whose token is the site's.
edge_error wrong_token(const session_hello& hello,
                       const session_challenge& challenge) {
  return {error_code::unauthorized,
          "the site token of node '" + hello.node + "' is not that of node '"
              + challenge.node + "' of cell '" + challenge.cell + "'",
          "copy the site token of one to the other, which reads it anew; a "
          "copy has the same sha256sum"};
}

/// A proof that the joiner has made, or wanted, without a token.
edge_error no_token(const session_hello& hello,
                    const session_challenge& challenge) {
  return {error_code::unauthorized,
          "node '" + hello.node + "' has no site token, and cell '"
              + challenge.cell + "' wants one",
          "copy the site token of node '" + challenge.node
              + "' to the host of node '" + hello.node + "'"};
}

/// The joiner reads this too, so it names the side that lacks the token.
edge_error tokenless_acceptor(const session_challenge& self) {
  return {error_code::unauthorized,
          "node '" + self.node + "' of cell '" + self.cell
              + "' has no site token, and without one it takes no sessions",
          "give node '" + self.node + "' the file of the site"};
}

handshake_step fail(edge_error why, bool notify_other_side) {
  handshake_step step;
  if (notify_other_side)
    step.reply = encode(why);
  step.failure = std::move(why);
  return step;
}

handshake_step fail_after_end() {
  return fail({error_code::conflict, "the handshake is over", ""}, false);
}

} // namespace

std::string make_nonce() {
  return to_hex(random_bytes(session_frame_bounds::nonce / 2));
}

acceptor_handshake::acceptor_handshake(acceptor_identity self,
                                       std::string token, std::string nonce)
    : token_(std::move(token)) {
  challenge_.version = session_version;
  challenge_.node = std::move(self.node);
  challenge_.uuid = std::move(self.uuid);
  challenge_.cell = std::move(self.cell);
  challenge_.incarnation = self.incarnation;
  agreement_.revocations = self.revocations;
  challenge_.nonce = std::move(nonce);
}

handshake_step acceptor_handshake::receive(std::string_view frame) {
  switch (std::exchange(state_, state::closed)) {
  case state::wait_hello:
    return on_hello(frame);
  case state::wait_proof:
    return on_proof(frame);
  default:
    return fail_after_end();
  }
}

handshake_step acceptor_handshake::on_hello(std::string_view frame) {
  if (token_.empty())
    return fail(tokenless_acceptor(challenge_), true);
  auto decoded = decode_frame<session_hello>(frame);
  if (auto* error = std::get_if<edge_error>(&decoded))
    return fail(*error, true);
  hello_ = std::get<session_hello>(std::move(decoded));
  if (auto refusal = check_version(hello_.node, hello_.version))
    return fail(*refusal, true);
  challenge_.proof =
      to_hex(keyed_digest(token_, acceptor_label, hello_, challenge_));
  state_ = state::wait_proof;
  handshake_step step;
  step.reply = encode(challenge_);
  return step;
}

handshake_step acceptor_handshake::on_proof(std::string_view frame) {
  auto decoded = decode_frame<session_proof>(frame);
  if (auto* error = std::get_if<edge_error>(&decoded))
    return fail(*error, true);
  const auto expected = keyed_digest(token_, joiner_label, hello_, challenge_);
  if (!is_proof(std::get<session_proof>(decoded).proof, expected))
    return fail(wrong_token(hello_, challenge_), true);
  agreement_.session = session_id(token_, hello_, challenge_);
  agreement_.keys.send =
      keyed_digest(token_, acceptor_heartbeat_label, hello_, challenge_);
  agreement_.keys.receive =
      keyed_digest(token_, joiner_heartbeat_label, hello_, challenge_);
  handshake_step step;
  step.reply =
      encode(session_accepted{agreement_.session, agreement_.revocations});
  step.done = true;
  return step;
}

joiner_handshake::joiner_handshake(joiner_identity self, std::string token,
                                   std::string expected_cell, std::string nonce)
    : token_(std::move(token)), expected_cell_(std::move(expected_cell)) {
  hello_.version = session_version;
  hello_.node = std::move(self.node);
  hello_.uuid = std::move(self.uuid);
  hello_.epoch = self.epoch;
  hello_.nonce = std::move(nonce);
  hello_.role = std::move(self.role);
}

std::string joiner_handshake::hello() const {
  return encode(hello_);
}

handshake_step joiner_handshake::receive(std::string_view frame) {
  switch (std::exchange(state_, state::closed)) {
  case state::wait_challenge:
    return on_challenge(frame);
  case state::wait_accepted:
    return on_accepted(frame);
  default:
    return fail_after_end();
  }
}

handshake_step joiner_handshake::on_challenge(std::string_view frame) {
  auto decoded = decode_frame<session_challenge>(frame);
  if (auto* error = std::get_if<edge_error>(&decoded))
    return fail(*error, false);
  challenge_ = std::get<session_challenge>(std::move(decoded));
  if (auto refusal = check_version(challenge_.node, challenge_.version))
    return fail(*refusal, true);
  if (token_.empty())
    return fail(no_token(hello_, challenge_), true);
  const auto expected =
      keyed_digest(token_, acceptor_label, hello_, challenge_);
  if (!is_proof(challenge_.proof, expected))
    return fail(wrong_token(hello_, challenge_), true);
  if (!expected_cell_.empty() && challenge_.cell != expected_cell_)
    return fail({error_code::unknown_cell,
                 "node '" + challenge_.node + "' coordinates cell '"
                     + challenge_.cell + "', not '" + expected_cell_ + "'",
                 ""},
                true);
  if (!expected_uuid_.empty() && challenge_.uuid != expected_uuid_)
    return fail({error_code::unknown_node,
                 "there is node '" + challenge_.node + "' with UUID "
                     + challenge_.uuid + ", not the one with UUID "
                     + expected_uuid_,
                 ""},
                true);
  state_ = state::wait_accepted;
  handshake_step step;
  step.reply = encode(session_proof{
      to_hex(keyed_digest(token_, joiner_label, hello_, challenge_))});
  return step;
}

handshake_step joiner_handshake::on_accepted(std::string_view frame) {
  auto decoded = decode_frame<session_accepted>(frame);
  if (auto* error = std::get_if<edge_error>(&decoded))
    return fail(*error, false);
  agreement_.session = session_id(token_, hello_, challenge_);
  const auto& accepted = std::get<session_accepted>(decoded);
  if (accepted.session != agreement_.session)
    return fail(wrong_token(hello_, challenge_), false);
  agreement_.revocations = accepted.revocations;
  agreement_.keys.send =
      keyed_digest(token_, joiner_heartbeat_label, hello_, challenge_);
  agreement_.keys.receive =
      keyed_digest(token_, acceptor_heartbeat_label, hello_, challenge_);
  handshake_step step;
  step.done = true;
  return step;
}

} // namespace roscell
