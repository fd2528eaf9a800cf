#pragma once

#include "actors/house/alarm.hpp"
#include "actors/house/house.hpp"
#include "actors/instances/skill_catalogue.hpp"
#include "messages/type_ids.hpp"

#include <chrono>
#include <optional>
#include <string>

namespace roscell {

struct skill_instance_config {
  house context;
  container_supervisor_actor supervisor; ///< Told of every change.
  runtime_actor runtime;
  state_store_actor store;
  shared_skill_catalogue skills;
  instance_row row;   ///< What is known of the instance.
  bool adopt = false; ///< It may run already.
};

/// Owns one instance from intent to end. The diagram is in docs/protocols.md.
struct skill_instance_state {
  static constexpr const char* name = "skill-instance";

  /// A container engine may have to fetch a base image of some GiB.
  static constexpr std::chrono::minutes build_limit{10};

  /// From the runtime's "start" to its answer.
  static constexpr std::chrono::seconds start_limit{30};

  /// From the start of the program to READY=1; loading a model takes a while.
  static constexpr std::chrono::seconds ready_limit{30};

  /// From the polite request to end to force.
  static constexpr std::chrono::seconds stop_grace{5};

  /// Beyond the grace; must exceed the runtime's stages of force.
  static constexpr std::chrono::seconds stop_limit{15};

  /// For one record on a slow disk, and for reading the end of a log.
  static constexpr std::chrono::seconds disk_limit{10};

  /// Most of the log's end that goes along with a failure, in bytes.
  static constexpr size_t log_tail_bytes = 8 * 1024;

  /// Most of what is said of why it ended, in bytes.
  static constexpr size_t reason_bytes = 2048;

  skill_instance_config config;
  instance_row row;
  bool begun = false;

  /// Raised at every turn; answers and ticks of an older one are ignored.
  uint64_t phase = 0;

  /// READY=1 came before the runtime's answer.
  bool ready = false;

  /// It has ended, and only the end of its log is waited for.
  bool concluding = false;

  std::optional<alarm::time_point> deadline;
  alarm timer;
};

/// The SKILL INSTANCE. Messages: messages/runtime.hpp.
skill_instance_actor::behavior_type skill_instance(
    skill_instance_actor::stateful_pointer<skill_instance_state> self,
    const skill_instance_config& config);

} // namespace roscell
