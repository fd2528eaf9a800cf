#pragma once

#include "messages/build.hpp"
#include "messages/resources.hpp"

#include <map>
#include <string>
#include <vector>

/// The launcher's half of a skill: what `skill.json` says. Plain types, so that
/// a skill or a tool can use them without an actor system.
namespace roscell {

struct port_description {
  std::vector<std::string> data_types; ///< "sensor_msgs/msg/Image", MIME types.
  std::vector<std::string> protocols;  ///< "ros2", "file", "video".

  static constexpr auto fields() {
    return field_list{required("data_types", &port_description::data_types),
                      required("protocols", &port_description::protocols)};
  }
};

/// How the kernel is to treat a program among others.
struct scheduling_request {
  std::string policy; ///< "other", "batch", "idle", "fifo", "rr"; empty: other.
  int64_t priority = 0; ///< 1 to 99 of the last two, else 0.
  int64_t nice = 0;     ///< -20 to 19 of the others.

  static constexpr auto fields() {
    return field_list{optional("policy", &scheduling_request::policy),
                      optional("priority", &scheduling_request::priority),
                      optional("nice", &scheduling_request::nice)};
  }
};

/// One way to run a model.
struct deployment_option {
  std::string name;
  std::string base_image; ///< Empty with the engine "actor" only.
  std::vector<std::string> architectures; ///< Never empty.
  resource_request resources;
  std::vector<std::string> devices; ///< Device nodes the host must have.
  std::map<std::string, std::string> labels; ///< Labels the node must have.
  std::map<std::string, std::string> environment;
  std::vector<std::string> volumes; ///< "/host/path:/container/path[:ro]".
  /// What of root's power it needs, "NET_RAW"; given where the node's
  /// configuration grants it to the skill, else the node is no place for it.
  std::vector<std::string> capabilities;
  bool read_only = false; ///< It writes nothing of its container but /tmp.
  scheduling_request scheduling; ///< Granted as `capabilities` are.
  /// JSON objects: what a step of it does unless the request says otherwise.
  std::string restart;
  std::string on_node_loss;
  std::string health;
  double safe_timeout_s = 0;
  std::string on_boot; ///< A word of `boot_action`; empty: as `life_of` says.

  static constexpr auto fields() {
    return field_list{
        required("name", &deployment_option::name),
        optional("base_image", &deployment_option::base_image),
        required("architectures", &deployment_option::architectures),
        required("resources", &deployment_option::resources),
        optional("devices", &deployment_option::devices),
        optional("labels", &deployment_option::labels),
        optional("environment", &deployment_option::environment),
        optional("volumes", &deployment_option::volumes),
        optional("capabilities", &deployment_option::capabilities),
        optional("read_only", &deployment_option::read_only),
        optional("scheduling", &deployment_option::scheduling),
        raw_json("restart", &deployment_option::restart),
        raw_json("on_node_loss", &deployment_option::on_node_loss),
        raw_json("health", &deployment_option::health),
        optional("safe_timeout_s", &deployment_option::safe_timeout_s),
        optional("on_boot", &deployment_option::on_boot)};
  }
};

/// One way to do the operation.
struct implementation_model {
  std::string name;
  std::string parameters; ///< JSON object, may be empty.
  std::vector<deployment_option> deployments;

  static constexpr auto fields() {
    return field_list{
        required("name", &implementation_model::name),
        raw_json("parameters", &implementation_model::parameters),
        required("deployments", &implementation_model::deployments)};
  }
};

/// A ROS 2 program that runs as it is, for the engine "ros2_standalone".
struct ros2_program {
  std::string package;    ///< Found by the ament index.
  std::string executable; ///< Of the package, or an absolute path.
  std::string launch;     ///< A launch file of the package, in its place.
  std::vector<std::string> setup; ///< Files to source first, "setup.bash".
  /// The program's own name for a topic, and the end of the step that it
  /// stands for: "input", "output", "input:1", "output:0".
  std::map<std::string, std::string> topics;
  /// Given to the program; to a launch file as "NAME:=VALUE".
  std::vector<std::string> arguments;
  std::string parameters; ///< JSON object: ROS parameters of its nodes.

  static constexpr auto fields() {
    return field_list{optional("package", &ros2_program::package),
                      optional("executable", &ros2_program::executable),
                      optional("launch", &ros2_program::launch),
                      optional("setup", &ros2_program::setup),
                      optional("topics", &ros2_program::topics),
                      optional("arguments", &ros2_program::arguments),
                      raw_json("parameters", &ros2_program::parameters)};
  }
};

/// JSON form: schemas/skill_descriptor.schema.json.
struct skill_descriptor {
  std::string operation;
  std::string version; ///< Raised by the author; empty: see installed_skill.
  std::string engine;  ///< "primitive", "ros2_standalone" or "actor".
  std::vector<std::string>
      entry_point; ///< Program below the folder, arguments.
  port_description input;
  port_description output;
  std::vector<implementation_model> models;
  std::vector<ros2_program> ros2; ///< One for "ros2_standalone", else none.
  bool safe_state = false;        ///< It says when it may be ended.
  bool may_start_alone = false;   ///< It may say `start`, safe state or not.

  static constexpr auto fields() {
    return field_list{
        required("operation", &skill_descriptor::operation),
        optional("version", &skill_descriptor::version),
        required("engine", &skill_descriptor::engine),
        optional("entry_point", &skill_descriptor::entry_point),
        required("input", &skill_descriptor::input),
        required("output", &skill_descriptor::output),
        required("models", &skill_descriptor::models),
        one_or_many("ros2", &skill_descriptor::ros2),
        optional("safe_state", &skill_descriptor::safe_state),
        optional("may_start_alone", &skill_descriptor::may_start_alone)};
  }
};

/// A build of a skill that a node has: a skill folder. Operation and version
/// say which skill it is. Two folders of the same content have the same hash,
/// whatever their names and places.
struct installed_skill {
  std::string hash; ///< SHA-256 over the folder's content, 64 hex digits.
  skill_descriptor descriptor;
  /// The descriptor's; else that of its sources, which a build may leave in
  /// `skill.version`; else the hash.
  std::string version;
  /// What its program is compiled for; empty: it runs on any.
  std::vector<std::string> architectures;
  int64_t added_unix_ms = 0; ///< When the folder last changed on its node.

  static constexpr auto fields() {
    return field_list{
        required("hash", &installed_skill::hash),
        required("descriptor", &installed_skill::descriptor),
        optional("version", &installed_skill::version),
        optional("architectures", &installed_skill::architectures),
        optional("added_unix_ms", &installed_skill::added_unix_ms)};
  }
};

/// Why a folder below a skill directory is no skill.
struct skill_problem {
  std::string path;    ///< File or folder it is about.
  std::string where;   ///< JSON pointer into that file, may be empty.
  std::string message; ///< What is wrong, one sentence.

  static constexpr auto fields() {
    return field_list{required("path", &skill_problem::path),
                      optional("where", &skill_problem::where),
                      required("message", &skill_problem::message)};
  }
};

/// Asks which skills the cell, or an independent node, can run.
struct skill_query {
  static constexpr const char* type = "skill_query";
  std::string operation; ///< Empty: all.
  /// Without the models of the cell's builds: there may be a thousand.
  bool brief = false;

  static constexpr auto fields() {
    return field_list{optional("operation", &skill_query::operation),
                      optional("brief", &skill_query::brief)};
  }
};

/// One build and the nodes that have it.
struct skill_row {
  installed_skill skill;
  std::vector<std::string> nodes;
  /// When each of the nodes got it, in their order.
  std::vector<int64_t> added_unix_ms;
  /// Those of the nodes that get it when they need it, and what comes then.
  std::vector<std::string> lacking;
  int64_t bytes = 0;

  static constexpr auto fields() {
    return field_list{required("skill", &skill_row::skill),
                      required("nodes", &skill_row::nodes),
                      optional("added_unix_ms", &skill_row::added_unix_ms),
                      optional("lacking", &skill_row::lacking),
                      optional("bytes", &skill_row::bytes)};
  }
};

/// A folder of a node that is no skill.
struct refused_skill {
  std::string node;
  skill_problem problem;

  static constexpr auto fields() {
    return field_list{required("node", &refused_skill::node),
                      required("problem", &refused_skill::problem)};
  }
};

/// A build that was added to the cell: it goes to each node that needs it.
struct cell_build {
  build_name build;
  installed_skill skill;
  int64_t added_unix_ms = 0;
  std::vector<std::string> keepers; ///< Nodes that never let it go.
  std::string signed_by; ///< spiffe://SITE/ROLE/NAME/UUID; empty: by nobody.
  // Said where it is asked for, not stored.
  std::vector<std::string> coming_to; ///< Nodes that fetch it for a step.
  int64_t instances = 0;              ///< What runs of it, or will.

  static constexpr auto fields() {
    return field_list{required("build", &cell_build::build),
                      required("skill", &cell_build::skill),
                      required("added_unix_ms", &cell_build::added_unix_ms),
                      required("keepers", &cell_build::keepers),
                      optional("signed_by", &cell_build::signed_by),
                      optional("coming_to", &cell_build::coming_to),
                      optional("instances", &cell_build::instances)};
  }
};

struct skill_list {
  static constexpr const char* type = "skill_list";
  std::vector<skill_row> skills;
  std::vector<refused_skill> refused; ///< In the order of the nodes.
  std::vector<cell_build> builds;     ///< Of the cell, by operation.

  static constexpr auto fields() {
    return field_list{required("skills", &skill_list::skills),
                      optional("refused", &skill_list::refused),
                      optional("builds", &skill_list::builds)};
  }
};

/// Adds a build to the cell's skills; a node of the cell has it.
struct skill_addition {
  static constexpr const char* type = "skill_addition";
  build_name build;
  std::string node;      ///< The one that has it.
  std::string signature; ///< As `roscell skill sign` makes it; may be empty.

  static constexpr auto fields() {
    return field_list{required("build", &skill_addition::build),
                      required("node", &skill_addition::node),
                      optional("signature", &skill_addition::signature)};
  }
};

/// It is on a second node, too, unless the cell has one only.
struct skill_added {
  static constexpr const char* type = "skill_added";
  cell_build added;

  static constexpr auto fields() {
    return field_list{required("added", &skill_added::added)};
  }
};

/// Takes builds from the cell's skills: all of an operation, or one.
struct skill_removal {
  static constexpr const char* type = "skill_removal";
  std::string operation;
  std::string build; ///< The first digits of its hash; empty: all.

  static constexpr auto fields() {
    return field_list{required("operation", &skill_removal::operation),
                      optional("build", &skill_removal::build)};
  }
};

struct skill_removed {
  static constexpr const char* type = "skill_removed";
  std::vector<cell_build> removed;

  static constexpr auto fields() {
    return field_list{required("removed", &skill_removed::removed)};
  }
};

/// Has a node fetch a build of the cell, the newest of an operation or one.
struct skill_pull {
  static constexpr const char* type = "skill_pull";
  std::string operation;
  std::string build; ///< The first digits of its hash; empty: the newest.
  std::string node;  ///< The one that fetches it.

  static constexpr auto fields() {
    return field_list{required("operation", &skill_pull::operation),
                      optional("build", &skill_pull::build),
                      required("node", &skill_pull::node)};
  }
};

/// The node has it now.
struct skill_pulled {
  static constexpr const char* type = "skill_pulled";
  cell_build pulled;

  static constexpr auto fields() {
    return field_list{required("pulled", &skill_pulled::pulled)};
  }
};

/// Has a node fetch a build and keep it for the cell.
struct build_keeping {
  static constexpr const char* type = "build_keeping";
  std::string cell;
  build_offer offer;
  bool pinned = true; ///< It stays there, whatever else needs the room.

  static constexpr auto fields() {
    return field_list{required("cell", &build_keeping::cell),
                      required("offer", &build_keeping::offer),
                      optional("pinned", &build_keeping::pinned)};
  }
};

struct build_kept {
  static constexpr const char* type = "build_kept";
  std::string hash;

  static constexpr auto fields() {
    return field_list{required("hash", &build_kept::hash)};
  }
};

/// The cell does not count on that copy any more.
struct build_release {
  static constexpr const char* type = "build_release";
  std::string hash;

  static constexpr auto fields() {
    return field_list{required("hash", &build_release::hash)};
  }
};

struct build_released {
  static constexpr const char* type = "build_released";
  std::string hash;

  static constexpr auto fields() {
    return field_list{required("hash", &build_released::hash)};
  }
};

} // namespace roscell
