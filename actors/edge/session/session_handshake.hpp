#pragma once

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/session/session_frames.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

/// The handshake of a session, without any input or output: each side feeds
/// the frames it gets into its state machine and sends what comes out.
///
///     joiner                                acceptor
///       | session_hello (nonce)  ------------> |
///       | <-- session_challenge (nonce, proof) |
///       | session_proof (proof)  ------------> |
///       | <------------------ session_accepted |
///
/// Both proofs are HMAC-SHA256 under the site token, over a label that is the
/// prover's side and everything that the hello and the challenge say: version,
/// name, UUID, epoch and role of the joiner; version, name, UUID, cell and
/// incarnation of the acceptor; both nonces. So a proof holds for this joiner,
/// this target and this run only. The acceptor proves itself first, and the
/// joiner stays silent towards one that cannot. The session id and the keys of
/// the heartbeat come from the same transcript under other labels.
namespace roscell {

/// Who asks for a session.
struct joiner_identity {
  std::string node;
  std::string uuid;
  int64_t epoch = 0;  ///< Of its registration; a coordinator's incarnation.
  std::string role{}; ///< `coordinator_role`, or empty.
};

/// Who takes it.
struct acceptor_identity {
  std::string node;
  std::string uuid;
  std::string cell;
  int64_t incarnation = 0;
  int64_t revocations = 0; ///< Number of its list of the revoked; 0: none.
};

/// Keys of the heartbeat of one session, one per direction, so that a packet
/// can never be reflected.
struct heartbeat_keys {
  digest send{};
  digest receive{};
};

/// What both sides know after the handshake.
struct session_agreement {
  std::string session; ///< 16 hexadecimal digits, unique by its nonces.
  heartbeat_keys keys;
  int64_t revocations = 0; ///< Number of the acceptor's list of the revoked.
};

/// One step of a side: send `reply` if there is one; then, if there is a
/// `failure`, close; else, if `done`, the session is open.
struct handshake_step {
  std::string reply;
  bool done = false;
  std::optional<edge_error> failure;
};

/// A fresh nonce: 32 random bytes, hexadecimal.
std::string make_nonce();

/// The acceptor's side. Every frame that is not the expected one ends it.
class acceptor_handshake {
public:
  /// Under an empty token nobody is let in.
  acceptor_handshake(acceptor_identity self, std::string token,
                     std::string nonce = make_nonce());

  handshake_step receive(std::string_view frame);

  /// Who the joiner says it is. Proven once the handshake is done.
  const session_hello& peer() const {
    return hello_;
  }

  /// Valid once the handshake is done.
  const session_agreement& agreement() const {
    return agreement_;
  }

private:
  enum class state { wait_hello, wait_proof, closed };

  handshake_step on_hello(std::string_view frame);
  handshake_step on_proof(std::string_view frame);

  state state_ = state::wait_hello;
  std::string token_;
  session_hello hello_;
  session_challenge challenge_;
  session_agreement agreement_;
};

/// The joiner's side.
class joiner_handshake {
public:
  /// `expected_cell` may be empty: then any cell will do. Under an empty token
  /// nobody is trusted.
  joiner_handshake(joiner_identity self, std::string token,
                   std::string expected_cell = {},
                   std::string nonce = make_nonce());

  /// Proves nothing to another node than this one.
  void expect_uuid(std::string uuid) {
    expected_uuid_ = std::move(uuid);
  }

  /// The frame to send first.
  std::string hello() const;

  handshake_step receive(std::string_view frame);

  /// Who the acceptor is. Proven once it was followed by a reply.
  const session_challenge& peer() const {
    return challenge_;
  }

  /// Valid once the handshake is done.
  const session_agreement& agreement() const {
    return agreement_;
  }

private:
  enum class state { wait_challenge, wait_accepted, closed };

  handshake_step on_challenge(std::string_view frame);
  handshake_step on_accepted(std::string_view frame);

  state state_ = state::wait_challenge;
  std::string token_;
  std::string expected_cell_;
  std::string expected_uuid_;
  session_hello hello_;
  session_challenge challenge_;
  session_agreement agreement_;
};

} // namespace roscell
