#pragma once

#include "messages/actors.hpp"
#include "messages/inside/introspection.hpp"
#include "messages/instance.hpp"
#include "messages/kept_log.hpp"
#include "messages/session.hpp"
#include "messages/skill.hpp"

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// What a container runtime is asked and what it tells. The `process` runtime
/// and the engine runtime speak it.
namespace roscell {

/// Makes the image of a skill ready; at once when it exists already.
struct prepare_image {
  std::string instance;  ///< For whom; it hears how a build gets on.
  std::string operation; ///< Names the image.
  std::string skill_dir; ///< Absolute path of the skill folder.
  std::string skill;     ///< Its content hash.
  std::string look;      ///< How it looked when it was hashed.
  std::vector<std::string> entry_point; ///< Empty: a program of the base image.
  std::string base_image;               ///< Ignored by the process runtime.

  static constexpr auto fields() {
    return field_list{required("instance", &prepare_image::instance),
                      required("operation", &prepare_image::operation),
                      required("skill_dir", &prepare_image::skill_dir),
                      required("skill", &prepare_image::skill),
                      optional("look", &prepare_image::look),
                      required("entry_point", &prepare_image::entry_point),
                      required("base_image", &prepare_image::base_image)};
  }
};

struct image_prepared {
  std::string image; ///< What `start_container` takes.

  static constexpr auto fields() {
    return field_list{required("image", &image_prepared::image)};
  }
};

struct start_container {
  std::string instance;
  std::string image;
  std::vector<std::string> command; ///< Entry point and its arguments.
  std::map<std::string, std::string> environment;
  std::map<std::string, std::string> labels; ///< task, instance, cell.
  resource_request limits;
  int gpu = -1; ///< Index of the GPU that it may use; negative: none.
  std::vector<io_endpoint> input;  ///< Files of it can be read,
  std::vector<io_endpoint> output; ///< and of these written.
  std::vector<std::string> devices;
  std::vector<std::string> volumes; ///< "/host/path:/container/path[:ro]".
  int stop_signal = 15;             ///< What asks the program to end.
  /// When it is ended unless that is moved on before, by the clock of the boot
  /// (CLOCK_BOOTTIME); 0: never.
  int64_t fence_boot_ms = 0;
  scheduling_request scheduling; ///< That the node's configuration grants.
  std::vector<std::string> capabilities; ///< The same, "NET_RAW".
  std::string user;       ///< The same; empty: the node's. Processes only.
  bool read_only = false; ///< Its root file system may be.
  /// Folder of the files that hold its secrets; empty: it has none.
  std::string secrets_folder;

  static constexpr auto fields() {
    return field_list{
        required("instance", &start_container::instance),
        required("image", &start_container::image),
        required("command", &start_container::command),
        required("environment", &start_container::environment),
        required("labels", &start_container::labels),
        required("limits", &start_container::limits),
        nullable("gpu", &start_container::gpu),
        one_or_many("input", &start_container::input),
        one_or_many("output", &start_container::output),
        required("devices", &start_container::devices),
        required("volumes", &start_container::volumes),
        optional("stop_signal", &start_container::stop_signal),
        optional("fence_boot_ms", &start_container::fence_boot_ms),
        optional("scheduling", &start_container::scheduling),
        optional("capabilities", &start_container::capabilities),
        optional("user", &start_container::user),
        optional("read_only", &start_container::read_only),
        optional("secrets_folder", &start_container::secrets_folder)};
  }
};

struct container_started {
  std::string container; ///< The runtime's id of it, kept for adoption.

  static constexpr auto fields() {
    return field_list{required("container", &container_started::container)};
  }
};

/// Ends a container: a polite request first, force after the grace time.
struct stop_container {
  std::string instance;
  std::string container; ///< Empty: whatever belongs to the instance.
  int64_t grace_ms = 5000;

  static constexpr auto fields() {
    return field_list{required("instance", &stop_container::instance),
                      required("container", &stop_container::container),
                      required("grace_ms", &stop_container::grace_ms)};
  }
};

/// The container's program has ended. Its log stays.
struct container_stopped {
  int exit_code = -1; ///< 128 + n after signal n; negative: not known.

  static constexpr auto fields() {
    return field_list{required("exit_code", &container_stopped::exit_code)};
  }
};

/// Ends by force what still runs of an instance, and drops all that the runtime
/// keeps of it. Its log goes to the history if it is said what it is kept with.
struct remove_container {
  std::string instance;
  std::string container; ///< Empty: whatever belongs to the instance.
  /// It is started again at once: a runtime whose log of an instance is one for
  /// all its runs goes on with that.
  bool restarts = false;
  std::vector<kept_log> about; ///< At most one.

  static constexpr auto fields() {
    return field_list{required("instance", &remove_container::instance),
                      required("container", &remove_container::container),
                      optional("restarts", &remove_container::restarts),
                      one_or_many("about", &remove_container::about)};
  }
};

struct container_removed {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// Takes over a container that an earlier run of this node has started.
struct adopt_container {
  std::string instance;
  std::string container; ///< Empty: whatever belongs to the instance.

  static constexpr auto fields() {
    return field_list{required("instance", &adopt_container::instance),
                      required("container", &adopt_container::container)};
  }
};

/// What has ended a program.
enum class end_cause {
  usual,       ///< Itself, or whoever has sent it a signal.
  memory,      ///< The kernel: it used more than it may, or there was no more.
  supervision, ///< The end of its shim, which somebody has killed.
};

constexpr auto enum_words(end_cause) {
  return std::array<std::string_view, 3>{"usual", "memory", "supervision"};
}

struct container_adopted {
  bool running = false;
  std::string container; ///< The runtime's id of it; empty: there is none.
  int exit_code = -1;    ///< Of one that ended meanwhile; negative: not known.
  bool recorded = false; ///< Its shim has written down how it ended,
  bool terminated = false; ///< and that it had been told to from outside.
  end_cause cause = end_cause::usual;
  double most_memory_mib = -1; ///< That it ever had; negative: not known.

  static constexpr auto fields() {
    return field_list{
        required("running", &container_adopted::running),
        required("container", &container_adopted::container),
        required("exit_code", &container_adopted::exit_code),
        optional("recorded", &container_adopted::recorded),
        optional("terminated", &container_adopted::terminated),
        optional("cause", &container_adopted::cause),
        optional("most_memory_mib", &container_adopted::most_memory_mib)};
  }
};

/// Moves the time on at which a container ends unless it is moved on again.
/// Only for what was started with such a time.
struct fence_container {
  std::string instance;
  std::string container;
  int64_t fence_boot_ms = 0;

  static constexpr auto fields() {
    return field_list{
        required("instance", &fence_container::instance),
        required("container", &fence_container::container),
        required("fence_boot_ms", &fence_container::fence_boot_ms)};
  }
};

/// Tells the program of a container that somebody waits for it to be stop-safe,
/// by SIGUSR1.
struct ask_for_safety {
  std::string instance;
  std::string container;

  static constexpr auto fields() {
    return field_list{required("instance", &ask_for_safety::instance),
                      required("container", &ask_for_safety::container)};
  }
};

/// Reads what waits at the NOTIFY_SOCKET of an instance. It is told as
/// `instance_notified` with `heard`, after all that has been read before.
struct hear_container {
  std::string instance;

  static constexpr auto fields() {
    return field_list{required("instance", &hear_container::instance)};
  }
};

/// An event: the container's program has ended, asked or not.
struct container_exited {
  std::string instance;
  std::string container;
  int exit_code = -1;
  bool terminated = false; ///< Its shim was told to end it, by whomever.
  end_cause cause = end_cause::usual;
  double most_memory_mib = -1; ///< As in `container_adopted`.

  static constexpr auto fields() {
    return field_list{
        required("instance", &container_exited::instance),
        required("container", &container_exited::container),
        required("exit_code", &container_exited::exit_code),
        optional("terminated", &container_exited::terminated),
        optional("cause", &container_exited::cause),
        optional("most_memory_mib", &container_exited::most_memory_mib)};
  }
};

/// An event: an instance said something on its NOTIFY_SOCKET.
struct instance_notified {
  std::string instance;
  bool ready = false;    ///< READY=1
  bool alive = false;    ///< WATCHDOG=1
  bool stopping = false; ///< STOPPING=1
  std::string status;    ///< STATUS=..., may be empty.
  bool heard = false;    ///< Answers `hear_container`; may say nothing else.
  safe_word safe = safe_word::untold;  ///< ROSCELL_SAFE=0 or 1
  std::vector<stream_metrics> streams; ///< ROSCELL_STREAMS=...
  std::vector<stream_count> frames;    ///< ROSCELL_FRAMES=...
  std::string remark;                  ///< ROSCELL_REMARK=...
  /// ROSCELL_PARAMETERS_TAKEN=..., the number of a change.
  int64_t parameters_taken = 0;
  /// ROSCELL_PARAMETERS_REFUSED=..., the number of a change, and why.
  int64_t parameters_refused = 0;
  std::string refusal;
  /// ROSCELL_PARAMETERS_WANTED=..., the number of a wish, and a JSON object.
  int64_t parameters_wanted = 0;
  std::string wanted_parameters;

  static constexpr auto fields() {
    return field_list{
        required("instance", &instance_notified::instance),
        required("ready", &instance_notified::ready),
        required("alive", &instance_notified::alive),
        required("stopping", &instance_notified::stopping),
        required("status", &instance_notified::status),
        required("heard", &instance_notified::heard),
        required("safe", &instance_notified::safe),
        required("streams", &instance_notified::streams),
        required("frames", &instance_notified::frames),
        required("remark", &instance_notified::remark),
        required("parameters_taken", &instance_notified::parameters_taken),
        required("parameters_refused", &instance_notified::parameters_refused),
        required("refusal", &instance_notified::refusal),
        required("parameters_wanted", &instance_notified::parameters_wanted),
        required("wanted_parameters", &instance_notified::wanted_parameters)};
  }
};

/// An event: the engine under the runtime cannot be asked at present, so what
/// is known of its containers may be outdated; or it can again.
struct runtime_problem_changed {
  std::string message; ///< Empty: the problem is over.

  static constexpr auto fields() {
    return field_list{required("message", &runtime_problem_changed::message)};
  }
};

/// INTERNAL to the process runtime: a watched program has ended.
struct program_ended {
  std::string instance;
  std::string container;

  static constexpr auto fields() {
    return field_list{required("instance", &program_ended::instance),
                      required("container", &program_ended::container)};
  }
};

/// INTERNAL to the process runtime: something was written to a watched log.
struct log_grown {
  std::string instance;

  static constexpr auto fields() {
    return field_list{required("instance", &log_grown::instance)};
  }
};

/// INTERNAL to supervision: bring the instance up, or take it over when an
/// earlier run of the node has brought it up.
struct start_instance {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// INTERNAL to supervision: take it down; repeated requests are harmless.
struct stop_instance {
  std::string reason;
  bool force = false; ///< It is not waited for to be stop-safe.

  static constexpr auto fields() {
    return field_list{required("reason", &stop_instance::reason),
                      required("force", &stop_instance::force)};
  }
};

/// An event: a word of this node, sent at that time by the clock of the boot,
/// has reached the coordinator. What may move to another node goes on until
/// then and its patience.
struct contact_proven {
  int64_t boot_ms = 0;
  /// With a registration: what the coordinator wants to go on.
  std::vector<std::string> kept;

  static constexpr auto fields() {
    return field_list{required("boot_ms", &contact_proven::boot_ms),
                      required("kept", &contact_proven::kept)};
  }
};

/// An event: the coordinator is out of reach, or is another one. Until it is
/// proven again nothing is known of what it wants to go on.
struct contact_lost {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// The coordinator keeps that these have ended, so the node may forget them.
struct ends_acknowledged {
  std::vector<std::string> instances;

  static constexpr auto fields() {
    return field_list{required("instances", &ends_acknowledged::instances)};
  }
};

/// What instances that are started from now on need to be in the cell, by this
/// node: it replaces what their specs say of the same variables.
struct use_environment {
  std::map<std::string, std::string> environment;

  static constexpr auto fields() {
    return field_list{required("environment", &use_environment::environment)};
  }
};

/// From the edge: something has changed in the folders of skills.
struct skill_folders_touched {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// Has the folders of skills read at once.
struct read_skills {
  static constexpr auto fields() {
    return field_list{};
  }
};

struct skills_read {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// Replaces whom the supervisor tells of changes.
struct listen_to_instances {
  instance_listener_actor listener;

  static constexpr auto fields() {
    return field_list{required("listener", &listen_to_instances::listener)};
  }
};

} // namespace roscell
