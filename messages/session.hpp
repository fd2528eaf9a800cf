#pragma once

#include "messages/instance.hpp"
#include "messages/node.hpp"
#include "messages/peer.hpp"
#include "messages/skill.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// What a member and its coordinator say to each other over their session.
/// Every frame is an envelope: a request and its reply share an id, a notice
/// has none. The handshake's frames are in
/// actors/edge/session/session_handshake.hpp.
namespace roscell {

struct session_request {
  static constexpr const char* type = "session_request";
  uint64_t id = 0;
  std::string body; ///< JSON of one message.

  static constexpr auto fields() {
    return field_list{required("id", &session_request::id),
                      raw_json("body", &session_request::body)};
  }
};

struct session_reply {
  static constexpr const char* type = "session_reply";
  uint64_t id = 0;
  std::string body;

  static constexpr auto fields() {
    return field_list{required("id", &session_reply::id),
                      raw_json("body", &session_reply::body)};
  }
};

struct session_notice {
  static constexpr const char* type = "session_notice";
  std::string body;

  static constexpr auto fields() {
    return field_list{raw_json("body", &session_notice::body)};
  }
};

/// Member to coordinator, first of all: who I am and what I run.
struct node_registration {
  static constexpr const char* type = "node_registration";
  node_identity identity;
  int64_t incarnation = 0; ///< The coordinator's, as its challenge told.
  node_resources resources;
  std::vector<installed_skill> skills;
  std::vector<instance_row> instances;
  join_origin origin = join_origin::given;
  std::string transfer; ///< The one that brings the node here, if any.
  std::vector<skill_problem> refused_skills; ///< The first of them.
  /// The only cell that the node comes back to; empty: whichever this is.
  std::string cell_uuid;
  /// Id of the discovery server that the node ran last, and the UUID of the
  /// cell that gave it; negative: none.
  int64_t server_id = -1;
  std::string server_cell;
  /// Its discovery server tells the cell's all that it knows anew after each
  /// registration.
  bool tells_anew = false;
  bool fetches_builds = false; ///< It can get skills from other nodes.

  static constexpr auto fields() {
    return field_list{
        required("identity", &node_registration::identity),
        required("incarnation", &node_registration::incarnation),
        required("resources", &node_registration::resources),
        required("skills", &node_registration::skills),
        required("instances", &node_registration::instances),
        optional("origin", &node_registration::origin),
        optional("transfer", &node_registration::transfer),
        optional("refused_skills", &node_registration::refused_skills),
        optional("cell_uuid", &node_registration::cell_uuid),
        optional("server_id", &node_registration::server_id),
        optional("server_cell", &node_registration::server_cell),
        optional("tells_anew", &node_registration::tells_anew),
        optional("fetches_builds", &node_registration::fetches_builds)};
  }
};

enum class verdict { keep, stop, start };

constexpr auto enum_words(verdict) {
  return std::array<std::string_view, 3>{"keep", "stop", "start"};
}

/// What the member shall do with one instance.
struct instance_verdict {
  std::string instance;
  verdict what = verdict::keep;
  std::vector<instance_spec> spec; ///< One element for `start`, else none.

  static constexpr auto fields() {
    return field_list{required("instance", &instance_verdict::instance),
                      required("verdict", &instance_verdict::what),
                      one_or_many("spec", &instance_verdict::spec)};
  }
};

/// Reply to `node_registration`.
struct node_registered {
  static constexpr const char* type = "node_registered";
  std::string cell;
  std::string coordinator;
  int64_t incarnation = 0;
  std::vector<instance_verdict> verdicts;
  std::string cell_uuid; ///< Empty: an older coordinator, which has none.
  /// At most one; none when the cell has no id left, or is older.
  std::vector<discovery_place> discovery;
  /// The cell's discovery server tells the member's all that it knows anew
  /// after each registration.
  bool tells_anew = false;
  /// The coordinator takes `skills_changed`; one of an earlier version counts
  /// it as a frame that makes no sense.
  bool hears_skills = false;
  /// What the coordinator signs permits with for builds that this node gives to
  /// others; empty: one of an earlier version.
  std::string build_key;

  static constexpr auto fields() {
    return field_list{required("cell", &node_registered::cell),
                      required("coordinator", &node_registered::coordinator),
                      required("incarnation", &node_registered::incarnation),
                      required("verdicts", &node_registered::verdicts),
                      optional("cell_uuid", &node_registered::cell_uuid),
                      one_or_many("discovery", &node_registered::discovery),
                      optional("tells_anew", &node_registered::tells_anew),
                      optional("hears_skills", &node_registered::hears_skills),
                      optional("build_key", &node_registered::build_key)};
  }
};

/// Member to coordinator: I leave.
struct node_departure {
  static constexpr const char* type = "node_departure";
  std::string reason;

  static constexpr auto fields() {
    return field_list{required("reason", &node_departure::reason)};
  }
};

struct node_departed {
  static constexpr const char* type = "node_departed";

  static constexpr auto fields() {
    return field_list{};
  }
};

/// Coordinator to member: what do you have, what of it is in use?
struct resource_query {
  static constexpr const char* type = "resource_query";

  static constexpr auto fields() {
    return field_list{};
  }
};

struct resource_report {
  static constexpr const char* type = "resource_report";
  node_resources resources;
  /// Instances that are not there yet and that `used` counts nevertheless.
  std::vector<std::string> reserved;

  static constexpr auto fields() {
    return field_list{required("resources", &resource_report::resources),
                      optional("reserved", &resource_report::reserved)};
  }
};

/// Coordinator to member: what do your live instances say of themselves?
struct figures_query {
  static constexpr const char* type = "figures_query";

  static constexpr auto fields() {
    return field_list{};
  }
};

/// What the skill of one instance has last said.
struct instance_status_text {
  std::string instance;
  std::string status;
  instance_metrics metrics;

  static constexpr auto fields() {
    return field_list{required("instance", &instance_status_text::instance),
                      optional("status", &instance_status_text::status),
                      optional("figures", &instance_status_text::metrics)};
  }
};

struct figures_report {
  static constexpr const char* type = "figures_report";
  std::vector<instance_status_text> instances;

  static constexpr auto fields() {
    return field_list{required("instances", &figures_report::instances)};
  }
};

/// Coordinator to member: run this instance. Repeating it is harmless.
struct instance_deployment {
  static constexpr const char* type = "instance_deployment";
  instance_spec spec;
  build_offer fetch; ///< Where the node gets the skill; no hash: it has it.

  static constexpr auto fields() {
    return field_list{required("spec", &instance_deployment::spec),
                      optional("fetch", &instance_deployment::fetch)};
  }
};

/// Reply to `instance_deployment`: it runs and said that it is ready.
struct instance_deployed {
  static constexpr const char* type = "instance_deployed";
  instance_row instance;

  static constexpr auto fields() {
    return field_list{required("instance", &instance_deployed::instance)};
  }
};

/// Coordinator to member: remove the instances of a task, or one of them.
struct instance_removal {
  static constexpr const char* type = "instance_removal";
  std::string task;
  std::string instance; ///< Empty: all of the task.
  bool force = false;   ///< Nothing is waited for to be stop-safe.

  static constexpr auto fields() {
    return field_list{required("task", &instance_removal::task),
                      optional("instance", &instance_removal::instance),
                      optional("force", &instance_removal::force)};
  }
};

/// Reply to `instance_removal`: they are gone, but for those that are not
/// stop-safe yet. These end by themselves, and asking again tells when they are
/// gone.
struct instances_removed {
  static constexpr const char* type = "instances_removed";
  std::vector<std::string> instances;
  std::vector<safety_wait> waiting;

  static constexpr auto fields() {
    return field_list{required("instances", &instances_removed::instances),
                      optional("waiting", &instances_removed::waiting)};
  }
};

/// Member to coordinator, a notice: an instance changed its state.
struct instance_changed {
  static constexpr const char* type = "instance_changed";
  instance_row instance;

  static constexpr auto fields() {
    return field_list{required("instance", &instance_changed::instance)};
  }
};

/// Member to coordinator, a notice: its skills are these from now on. It is
/// told after the registration whose answer `hears_skills`, and not to others.
struct skills_changed {
  static constexpr const char* type = "skills_changed";
  std::vector<installed_skill> skills;       ///< All that it has.
  std::vector<skill_problem> refused_skills; ///< The first of them.

  static constexpr auto fields() {
    return field_list{
        required("skills", &skills_changed::skills),
        optional("refused_skills", &skills_changed::refused_skills)};
  }
};

/// What a UDP packet between two nodes of a session says.
enum class heartbeat_kind : uint8_t {
  heartbeat, ///< I am here; wants an ack.
  ack,       ///< I have got a heartbeat.
  probe,     ///< Are you there? Wants a heartbeat at once.
};

constexpr auto enum_words(heartbeat_kind) {
  return std::array<std::string_view, 3>{"beat", "ack", "probe"};
}

} // namespace roscell
