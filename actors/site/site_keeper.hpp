#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/edge/http/client/http_call.hpp"
#include "actors/edge/trust/invitation_table.hpp"
#include "actors/edge/trust/site_identity.hpp"
#include "actors/site/issued_names.hpp"
#include "actors/site/known_nodes.hpp"
#include "messages/messages.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

struct site_keeper_config {
  actor_context context;
  /// Asks another node without waiting; null: it asks no coordinator.
  std::function<void(http_call, std::function<void(http_outcome)>)> ask;
  std::string node;
  std::string uuid;
  bool coordinator = false;
  std::shared_ptr<site_identity> identity; ///< Null: it has a token.
  /// Where its identity is, or will be; see identity_place.hpp.
  std::filesystem::path file;
  std::vector<std::string> addresses; ///< Where newcomers come: "ip:port".
  std::shared_ptr<known_nodes> known = std::make_shared<known_nodes>();
  std::function<void()> start_anew; ///< See `node_additions`; may be null.
};

/// The keys that a certificate was asked for with.
struct asked_keys {
  private_key own;
  std::optional<private_key> issuing;
};

/// Owns what the node is at its site: its identity's files, the key by which a
/// coordinator makes identities of nodes, and the invitations that are open.
/// Spawned as one that blocks: it reads and writes those files.
struct site_keeper_state {
  static constexpr const char* name = "site-keeper";

  using time_point = std::chrono::steady_clock::time_point;

  site_keeper_config config;
  std::optional<own_identity> issuer; ///< None: it makes no identities.
  issued_names issued;                ///< Whom it has made identities for.
  invitation_table invitations;
  std::optional<asked_keys> asked;
  /// It has an identity on the disk that counts once it is made anew.
  bool is_changing = false;
  std::optional<note_coordinator> coordinator; ///< The last it has met.
  bool is_renewing = false;
  time_point next_renewal; ///< Not asked for earlier.
  alarm timer;
};

/// The SITE KEEPER. Messages: messages/site.hpp. Events: certificate_issued,
/// identity_taken, renewal_failed, revocations_taken.
site_keeper_actor::behavior_type
site_keeper(site_keeper_actor::stateful_pointer<site_keeper_state> self,
            const site_keeper_config& config);

// INTERNAL to this folder.

using site_keeper_pointer =
    site_keeper_actor::stateful_pointer<site_keeper_state>;

/// Nothing is asked of one that is about to be of another site.
caf::error refuse_while_changing(site_keeper_pointer self);

/// Seconds since 1970, as far as this node can know.
int64_t site_time_s(site_keeper_pointer self);

/// What the site keeper says to others who want to be somebody.
caf::result<site_invited> keep_invitation(site_keeper_pointer self,
                                          const site_invitation& x);
caf::result<site_entered> let_in(site_keeper_pointer self, const site_entry& x);
caf::result<site_entered> renew_other(site_keeper_pointer self,
                                      const site_renewal& x);

/// What becomes of its own identity.
caf::result<identity_requested> request_identity(site_keeper_pointer self);
caf::result<identity_set> set_identity(site_keeper_pointer self,
                                       const identity_setting& x);
caf::result<revocations_set> set_revocations(site_keeper_pointer self,
                                             const revocation_setting& x);
void meet_coordinator(site_keeper_pointer self, const note_coordinator& x);
void take_renewal(site_keeper_pointer self, const renewal_answered& x);
void look_at_time(site_keeper_pointer self);

/// False: it is no list of this site. An older one than is known does nothing.
bool take_list_of_revoked(site_keeper_pointer self, const std::string& text);

/// @param later see `identity_set`.
void publish_identity(site_keeper_pointer self, const own_identity& own,
                      bool later);

} // namespace roscell
