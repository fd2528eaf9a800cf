#pragma once

#include "messages/actors.hpp"
#include "messages/failure.hpp"
#include "messages/inside/introspection.hpp"
#include "messages/node.hpp"
#include "messages/session.hpp"

#include <array>
#include <string>
#include <string_view>

/// The seam between protocol actors and the wire: one authenticated session.
/// Production puts a WebSocket behind it, tests a link that loses, delays,
/// repeats and cuts.
namespace roscell {

struct send_frame {
  std::string text;

  static constexpr auto fields() {
    return field_list{required("text", &send_frame::text)};
  }
};

struct frame_received {
  std::string text;

  static constexpr auto fields() {
    return field_list{required("text", &frame_received::text)};
  }
};

struct send_heartbeat {
  heartbeat_kind kind = heartbeat_kind::heartbeat;
  uint32_t answers = 0; ///< With an ack: the number of the heartbeat.

  static constexpr auto fields() {
    return field_list{required("kind", &send_heartbeat::kind),
                      required("answers", &send_heartbeat::answers)};
  }
};

struct heartbeat_received {
  heartbeat_kind kind = heartbeat_kind::heartbeat;
  uint32_t sequence = 0; ///< An ack has that of the heartbeat it answers.
  /// When the heartbeat that an ack answers was sent, by the clock of the boot;
  /// 0: it answers none of the last ones.
  int64_t sent_boot_ms = 0;

  static constexpr auto fields() {
    return field_list{
        required("kind", &heartbeat_received::kind),
        required("sequence", &heartbeat_received::sequence),
        required("sent_boot_ms", &heartbeat_received::sent_boot_ms)};
  }
};

struct close_session {
  std::string reason;

  static constexpr auto fields() {
    return field_list{required("reason", &close_session::reason)};
  }
};

/// An event, the last one of a session.
struct session_closed {
  std::string reason;

  static constexpr auto fields() {
    return field_list{required("reason", &session_closed::reason)};
  }
};

struct own_session {
  session_owner_actor owner;

  static constexpr auto fields() {
    return field_list{required("owner", &own_session::owner)};
  }
};

/// An event for the COORDINATOR: a node has proved that it knows the site
/// token.
struct session_admitted {
  session_actor session;
  node_identity peer;
  node_role role = node_role::primary; ///< A coordinator is a peer.

  static constexpr auto fields() {
    return field_list{required("session", &session_admitted::session),
                      required("peer", &session_admitted::peer),
                      required("role", &session_admitted::role)};
  }
};

/// Opens a session to a coordinator.
struct open_session {
  std::string address; ///< "ip:port"
  node_identity self;
  node_role role = node_role::primary;
  std::string uuid; ///< The only node that may answer there; empty: any.

  static constexpr auto fields() {
    return field_list{required("address", &open_session::address),
                      required("self", &open_session::self),
                      required("role", &open_session::role),
                      required("uuid", &open_session::uuid)};
  }
};

struct session_opened {
  session_actor session;
  std::string cell;
  std::string coordinator;
  int64_t incarnation = 0;

  static constexpr auto fields() {
    return field_list{required("session", &session_opened::session),
                      required("cell", &session_opened::cell),
                      required("coordinator", &session_opened::coordinator),
                      required("incarnation", &session_opened::incarnation)};
  }
};

/// INTERNAL to the session connector: an attempt has come to its end.
struct session_settled {
  uint64_t attempt = 0;
  session_opened opened; ///< Its session is invalid if there is a problem.
  failure problem;

  static constexpr auto fields() {
    return field_list{required("attempt", &session_settled::attempt),
                      required("opened", &session_settled::opened),
                      required("problem", &session_settled::problem)};
  }
};

/// Looks for the discovery server at an address until told to stop.
struct find_coordinator {
  std::string address; ///< "ip:port"

  static constexpr auto fields() {
    return field_list{required("address", &find_coordinator::address)};
  }
};

/// Deletes the CLIENT participant: from here on nobody is looked for.
struct forget_coordinator {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// Runs the node's own discovery server, for the ROS 2 programs on this node,
/// from now on. Repeating it is harmless.
struct serve_programs {
  discovery_place place;
  uint16_t port = 0; ///< UDP, as before; 0: as the node is set up.
  /// The session with the coordinator has begun; else it has ended, or is yet
  /// to come.
  bool remote_is_there = false;
  bool tells_anew = false; ///< See `node_registered`.

  static constexpr auto fields() {
    return field_list{
        required("place", &serve_programs::place),
        required("port", &serve_programs::port),
        required("remote_is_there", &serve_programs::remote_is_there),
        optional("tells_anew", &serve_programs::tells_anew)};
  }
};

struct programs_served {
  std::string address; ///< "ip:port" of the server.

  static constexpr auto fields() {
    return field_list{required("address", &programs_served::address)};
  }
};

enum class server_contact {
  met,     ///< The session with its node has begun.
  lost,    ///< It has ended.
  gone,    ///< Its node is not of the cell any more.
  settled, ///< INTERNAL: by now it has told of all that is there.
};

constexpr auto enum_words(server_contact) {
  return std::array<std::string_view, 4>{"met", "lost", "gone", "settled"};
}

/// What becomes of the discovery server of another node. Repeating it is
/// harmless, but that `met` begins anew.
struct follow_server {
  int64_t server_id = 0;
  server_contact contact = server_contact::met;
  bool tells_anew = false; ///< With `met`: see `node_registration`.
  int64_t meeting = 0;     ///< With `settled`: which one.

  static constexpr auto fields() {
    return field_list{required("server_id", &follow_server::server_id),
                      required("contact", &follow_server::contact),
                      optional("tells_anew", &follow_server::tells_anew),
                      optional("meeting", &follow_server::meeting)};
  }
};

/// The node is in no cell any more: its server says farewell.
struct stop_serving {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// Looks after the endpoints that a program on this node should have, as long
/// as the sender lives. It is told what is missing, at once and whenever
/// that changes.
struct watch_endpoints {
  std::string instance;
  std::string program; ///< Name of its DDS participant; empty: any.
  std::vector<std::string> written; ///< Topics that it should write,
  std::vector<std::string> read;    ///< and read: "/scene_1/image".

  static constexpr auto fields() {
    return field_list{required("instance", &watch_endpoints::instance),
                      required("program", &watch_endpoints::program),
                      required("written", &watch_endpoints::written),
                      required("read", &watch_endpoints::read)};
  }
};

/// An event: what of the watched endpoints is not there.
struct endpoints_missing {
  std::string instance;
  std::vector<std::string> missing; ///< "a writer of /scene_1/image"

  static constexpr auto fields() {
    return field_list{required("instance", &endpoints_missing::instance),
                      required("missing", &endpoints_missing::missing)};
  }
};

/// INTERNAL to the graph watch: the discovery server has learned something.
struct graph_changed {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// An event: the discovery server has told who coordinates its cell.
struct coordinator_found {
  std::string cell;
  std::string coordinator;
  std::string address; ///< "ip:port" for sessions.
  int64_t incarnation = 0;

  static constexpr auto fields() {
    return field_list{required("cell", &coordinator_found::cell),
                      required("coordinator", &coordinator_found::coordinator),
                      required("address", &coordinator_found::address),
                      required("incarnation", &coordinator_found::incarnation)};
  }
};

/// What a node announces to everybody, or is known to announce.
struct node_presence {
  std::string role; ///< "coordinator", "independent" or "orphaned".
  std::string name;
  std::string uuid;
  int64_t epoch = 0;            ///< Of the registration; not of a coordinator.
  int64_t incarnation = 0;      ///< Coordinators only.
  std::string cell;             ///< Coordinated, or last been in.
  std::string address;          ///< Of its HTTP port.
  std::string discovery_server; ///< "ip:port"; coordinators only.
  int64_t server_id = 0;        ///< Of the discovery server.
  std::string cell_uuid;        ///< Of the cell; not of an independent node.

  static constexpr auto fields() {
    return field_list{
        required("role", &node_presence::role),
        required("name", &node_presence::name),
        required("uuid", &node_presence::uuid),
        required("epoch", &node_presence::epoch),
        required("incarnation", &node_presence::incarnation),
        required("cell", &node_presence::cell),
        required("address", &node_presence::address),
        required("discovery_server", &node_presence::discovery_server),
        required("server_id", &node_presence::server_id),
        optional("cell_uuid", &node_presence::cell_uuid)};
  }
};

/// Announces this from now on; the public participant is made if need be.
struct announce_presence {
  node_presence self;

  static constexpr auto fields() {
    return field_list{required("self", &announce_presence::self)};
  }
};

/// Deletes the public participant: nobody sees the node, and it sees nobody.
struct withdraw_presence {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// An event: somebody announces this.
struct presence_seen {
  node_presence who;

  static constexpr auto fields() {
    return field_list{required("who", &presence_seen::who)};
  }
};

/// An event: somebody has said farewell or was silent for long.
struct presence_gone {
  node_presence who; ///< As announced last.

  static constexpr auto fields() {
    return field_list{required("who", &presence_gone::who)};
  }
};

} // namespace roscell
