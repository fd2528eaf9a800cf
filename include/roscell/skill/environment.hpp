#pragma once

#include "roscell/skill/parameters.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell::engine {

/// One input or output of a step.
struct stream {
  std::string protocol;  ///< e.g. `file`, `ros2`
  std::string endpoint;  ///< what the protocol takes for an address
  std::string data_type; ///< media type or ROS type name
};

/// All that a node tells an instance, as plain values that never change once
/// the skill runs: any thread may read them. These environment variables are
/// the contract between the two, for containers and processes alike:
///
/// | variable | value | if absent |
/// |---|---|---|
/// | ROSCELL_MODEL | implementation model to run | error |
/// | ROSCELL_INPUTS | JSON array of 1 to 64 {"protocol", "endpoint",
///   "data_type"} | error |
/// | ROSCELL_OUTPUTS | the same, 0 to 64 | error |
/// | ROSCELL_PARAMETERS | JSON object: the model's parameters with the step's
///   overrides applied | {} |
/// | ROSCELL_TASK, ROSCELL_STEP, ROSCELL_INSTANCE, ROSCELL_OPERATION,
///   ROSCELL_DEPLOYMENT | names | empty |
/// | ROSCELL_GPU | index of the GPU to use | no GPU |
/// | NOTIFY_SOCKET | datagram socket of the node in systemd's protocol: a path,
///   or `@` and an abstract name | nothing is reported |
/// | WATCHDOG_USEC | the node takes the skill for hung after so many
///   microseconds without WATCHDOG=1 | no watchdog |
/// | ROSCELL_SECRETS | folder with a file for each secret that the step names |
///   there are none |
/// | ROSCELL_CHANGEABLE | JSON object: those of them that can be changed while
///   it runs, as the descriptor declares them | none can |
/// | ROSCELL_ROS2_SET_PARAMETERS | 1: clients of ROS 2 may change those | they
///   are refused |
/// | ROSCELL_HEALTH | 1: the node wants to know what the streams do | it is not
///   told |
struct environment {
  std::string task;
  std::string step;
  std::string instance;
  std::string operation;
  std::string model;
  std::string deployment;
  std::vector<stream> inputs;
  std::vector<stream> outputs;
  engine::parameters parameters;
  std::string changeable; ///< JSON object; empty: none.
  bool ros2_set_parameters = false;
  std::optional<unsigned> gpu;
  std::string notify_socket;
  std::optional<std::chrono::microseconds> watchdog;
  bool health = false;
  std::string secrets_folder; ///< Empty: the step names none.

  /// The bytes of a secret that the step names in "secrets", read from its
  /// file, 64 KiB at most. Throws start_error, whose text names the remedy,
  /// where it has not been given.
  std::string secret(const std::string& name) const;
};

/// Variables that have got other values while the skill runs.
using changed_variables = std::map<std::string, std::string>;

/// Returns the value of a variable, or nullptr.
using variable_lookup = std::function<const char*(const char* name)>;

/// Reads and checks the contract. Throws start_error, whose text names the
/// variable, when one is missing or makes no sense.
environment read_environment(const variable_lookup& lookup);

/// Reads the environment of this process.
environment read_environment();

} // namespace roscell::engine
