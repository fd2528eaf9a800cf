#pragma once

#include "messages/codec/json_codec.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// Identities of a site: how they are asked for, made, given and taken back.
/// Certificates are texts of PEM, keys never leave the machine that made them.
namespace roscell {

/// Asks a node what it is at its site.
struct site_query {
  static constexpr const char* type = "site_query";
  std::string node; ///< Of its cell; empty: the one that is asked.

  static constexpr auto fields() {
    return field_list{optional("node", &site_query::node)};
  }
};

/// An invitation that has not been used.
struct invitation_row {
  std::string id;
  std::string node; ///< It is for; empty: any.
  std::string role;
  int64_t made_unix_ms = 0;

  static constexpr auto fields() {
    return field_list{required("id", &invitation_row::id),
                      optional("node", &invitation_row::node),
                      required("role", &invitation_row::role),
                      required("made_unix_ms", &invitation_row::made_unix_ms)};
  }
};

struct site_status {
  static constexpr const char* type = "site_status";
  std::string trust;    ///< What it believes: "token" or "identity".
  std::string site;     ///< Empty, as what follows: it has no identity.
  std::string digest;   ///< Of the site's certificate.
  std::string identity; ///< spiffe://SITE/ROLE/NAME/UUID
  std::string serial;
  int64_t ends_unix_s = 0;
  int64_t revocations = 0; ///< Number of its list of the revoked.
  bool issues = false;     ///< It makes identities of nodes.
  std::vector<invitation_row> invitations;

  static constexpr auto fields() {
    return field_list{required("trust", &site_status::trust),
                      optional("site", &site_status::site),
                      optional("digest", &site_status::digest),
                      optional("identity", &site_status::identity),
                      optional("serial", &site_status::serial),
                      optional("ends_unix_s", &site_status::ends_unix_s),
                      optional("revocations", &site_status::revocations),
                      optional("issues", &site_status::issues),
                      optional("invitations", &site_status::invitations)};
  }
};

/// Has a coordinator keep an invitation. It is not told the secret, only what
/// the secret's owner proves.
struct site_invitation {
  static constexpr const char* type = "site_invitation";
  std::string node;   ///< It is for; empty: any.
  std::string role;   ///< "node", or that of the identity in `deposit`.
  std::string secret; ///< What is proved, 32 hexadecimal digits.
  /// An identity that was made before, for him who has the whole secret alone
  /// to open, in hexadecimal; empty: the coordinator makes one of a node.
  std::string deposit;

  static constexpr auto fields() {
    return field_list{optional("node", &site_invitation::node),
                      required("role", &site_invitation::role),
                      required("secret", &site_invitation::secret),
                      optional("deposit", &site_invitation::deposit)};
  }
};

struct site_invited {
  static constexpr const char* type = "site_invited";
  std::string site;
  std::string digest;                 ///< Of the site's certificate.
  std::vector<std::string> addresses; ///< Where to come.
  int64_t until_unix_ms = 0;

  static constexpr auto fields() {
    return field_list{required("site", &site_invited::site),
                      required("digest", &site_invited::digest),
                      required("addresses", &site_invited::addresses),
                      required("until_unix_ms", &site_invited::until_unix_ms)};
  }
};

/// A newcomer shows an invitation.
struct site_entry {
  static constexpr const char* type = "site_entry";
  std::string invitation; ///< Its id.
  std::string proof;
  std::string node; ///< How the newcomer is called.
  std::string uuid;
  std::string request; ///< For a certificate (PKCS #10, DER), in hexadecimal.
  /// Of the connection that it came by, in hexadecimal; the node that is asked
  /// writes it in itself.
  std::string exported;

  static constexpr auto fields() {
    return field_list{required("invitation", &site_entry::invitation),
                      required("proof", &site_entry::proof),
                      required("node", &site_entry::node),
                      required("uuid", &site_entry::uuid),
                      optional("request", &site_entry::request),
                      optional("exported", &site_entry::exported)};
  }
};

/// Asks for the list of the revoked, and for a fresh certificate of the key
/// that the asker has proved by TLS.
struct site_renewal {
  static constexpr const char* type = "site_renewal";
  bool certificate = false; ///< Not the list alone.
  /// The certificate that he has shown; the node that is asked writes it in.
  std::string peer;

  static constexpr auto fields() {
    return field_list{optional("certificate", &site_renewal::certificate),
                      optional("peer", &site_renewal::peer)};
  }
};

/// The answer to both.
struct site_entered {
  static constexpr const char* type = "site_entered";
  std::string chain;   ///< Certificates, one's own first; empty: see `deposit`.
  std::string site;    ///< The site's certificate.
  std::string revoked; ///< The signed list; may be empty.
  std::string deposit; ///< As in `site_invitation`.

  static constexpr auto fields() {
    return field_list{optional("chain", &site_entered::chain),
                      optional("site", &site_entered::site),
                      optional("revoked", &site_entered::revoked),
                      optional("deposit", &site_entered::deposit)};
  }
};

/// Has a node say what a certificate for it has to be made of.
struct identity_request_query {
  static constexpr const char* type = "identity_request_query";
  std::string node; ///< As in `site_query`.

  static constexpr auto fields() {
    return field_list{optional("node", &identity_request_query::node)};
  }
};

struct identity_requested {
  static constexpr const char* type = "identity_requested";
  std::string node;
  std::string uuid;
  bool coordinator = false;
  std::string request; ///< As in `site_entry`, of its own key,
  std::string issuing; ///< and of the key it signs with; coordinators only.

  static constexpr auto fields() {
    return field_list{required("node", &identity_requested::node),
                      required("uuid", &identity_requested::uuid),
                      optional("coordinator", &identity_requested::coordinator),
                      required("request", &identity_requested::request),
                      optional("issuing", &identity_requested::issuing)};
  }
};

/// Gives a node the certificates that were made of what it said.
struct identity_setting {
  static constexpr const char* type = "identity_setting";
  std::string node; ///< As in `site_query`.
  std::string chain;
  std::string issuing; ///< For the key it signs with; coordinators only.
  std::string site;
  std::string revoked;

  static constexpr auto fields() {
    return field_list{optional("node", &identity_setting::node),
                      required("chain", &identity_setting::chain),
                      optional("issuing", &identity_setting::issuing),
                      required("site", &identity_setting::site),
                      optional("revoked", &identity_setting::revoked)};
  }
};

struct identity_set {
  static constexpr const char* type = "identity_set";
  std::string identity; ///< spiffe://SITE/ROLE/NAME/UUID
  int64_t ends_unix_s = 0;
  /// It counts once the node has started anew, which it does by itself where
  /// its program lets it, a member when its session ends.
  bool later = false;

  static constexpr auto fields() {
    return field_list{required("identity", &identity_set::identity),
                      required("ends_unix_s", &identity_set::ends_unix_s),
                      optional("later", &identity_set::later)};
  }
};

/// Gives a node the list of the revoked. An older one than it has changes
/// nothing.
struct revocation_setting {
  static constexpr const char* type = "revocation_setting";
  std::string node; ///< As in `site_query`.
  std::string list; ///< As the site has signed it.

  static constexpr auto fields() {
    return field_list{optional("node", &revocation_setting::node),
                      required("list", &revocation_setting::list)};
  }
};

struct revocations_set {
  static constexpr const char* type = "revocations_set";
  int64_t number = 0; ///< Of the list that the node has now.
  int64_t revoked = 0;

  static constexpr auto fields() {
    return field_list{required("number", &revocations_set::number),
                      required("revoked", &revocations_set::revoked)};
  }
};

/// Asks who has changed what.
struct audit_query {
  static constexpr const char* type = "audit_query";
  int64_t since = 0;  ///< Records of higher numbers,
  int64_t newest = 0; ///< and the newest so many of them; 0: all that fit.
  std::string node;   ///< As in `site_query`.

  static constexpr auto fields() {
    return field_list{optional("since", &audit_query::since),
                      optional("newest", &audit_query::newest),
                      optional("node", &audit_query::node)};
  }
};

/// One change that somebody asked for, and what became of it.
struct audit_record {
  int64_t number = 0; ///< From 1, without a gap.
  int64_t unix_ms = 0;
  std::string from; ///< "operator anna at 10.0.0.3:40112", "root"
  std::string request;
  std::string subject;
  std::string outcome; ///< "done", or the code of a refusal.
  std::string hash;    ///< Over all of this and the hash before.

  static constexpr auto fields() {
    return field_list{required("number", &audit_record::number),
                      required("unix_ms", &audit_record::unix_ms),
                      required("from", &audit_record::from),
                      required("request", &audit_record::request),
                      optional("subject", &audit_record::subject),
                      required("outcome", &audit_record::outcome),
                      required("hash", &audit_record::hash)};
  }
};

struct audit_list {
  static constexpr const char* type = "audit_list";
  std::vector<audit_record> records; ///< The oldest first.
  /// What of the chain is missing or was changed, as a sentence; empty: it is
  /// whole.
  std::string gap;

  static constexpr auto fields() {
    return field_list{required("records", &audit_list::records),
                      optional("gap", &audit_list::gap)};
  }
};

/// INTERNAL to a node: a request has been answered.
struct note_change {
  std::string from;
  std::string request;
  std::string subject;
  std::string outcome;

  static constexpr auto fields() {
    return field_list{required("from", &note_change::from),
                      required("request", &note_change::request),
                      required("subject", &note_change::subject),
                      required("outcome", &note_change::outcome)};
  }
};

/// INTERNAL to a node: it has a session with a coordinator, or tried to have
/// one.
struct note_coordinator {
  std::string address; ///< "ip:port" of the coordinator.
  std::string uuid;    ///< His; may be empty where there is no session.
  bool present = false;
  int64_t revocations = 0; ///< Number of his list.

  static constexpr auto fields() {
    return field_list{required("address", &note_coordinator::address),
                      required("uuid", &note_coordinator::uuid),
                      required("present", &note_coordinator::present),
                      required("revocations", &note_coordinator::revocations)};
  }
};

/// INTERNAL to the site keeper: what a coordinator has answered it.
struct renewal_answered {
  std::string text;    ///< A `site_entered`; empty: see `problem`.
  std::string problem; ///< A sentence.

  static constexpr auto fields() {
    return field_list{required("text", &renewal_answered::text),
                      required("problem", &renewal_answered::problem)};
  }
};

} // namespace roscell
