#pragma once

#include "messages/failure.hpp"
#include "messages/inside/runtime.hpp"
#include "messages/instance.hpp"
#include "messages/kept_log.hpp"
#include "messages/skill.hpp"

#include <chrono>
#include <map>
#include <string>

namespace roscell {

/// Names the folder with the files of its secrets.
constexpr const char* secrets_variable = "ROSCELL_SECRETS";

/// What an instance is told by its environment: the contract of
/// skills/engine/environment.hpp, without NOTIFY_SOCKET, which is the
/// runtime's. The deployment option's own variables come first, the spec's
/// replace them, then the node's, then the contract's.
std::map<std::string, std::string>
instance_environment(const instance_spec& spec,
                     const deployment_option& deployment,
                     const std::map<std::string, std::string>& of_node = {});

/// The parameters of a model that can be changed while it runs, as it declares
/// them, a JSON object; empty: none can.
std::string changeable_parameters(const skill_descriptor& skill,
                                  const std::string& model);

// Texts about instances: how they have ended, and why.

/// "with exit code 3", "by signal 9", or "in an unknown way" for a negative
/// one.
std::string exit_code_text(int code);

/// Why a program of that row has ended: "out of memory: it may use 64 MiB"
/// where that is known, else how, "it ended by signal 9".
std::string end_reason_text(const instance_row& row, end_cause cause,
                            double most_memory_mib);

/// What a shim is told of it: "fifo:20:0"; empty: as any program.
std::string scheduling_word(const scheduling_request& request);

/// The last bytes of a text, beginning with a whole line where there is one.
std::string last_bytes(const std::string& text, size_t max_bytes);

/// Why an ended instance does not run, for whoever has asked for it:
/// engine_failed with details, or conflict if it was stopped on purpose.
failure deployment_failure(const instance_row& row);

/// With what the log of an instance's last run is kept.
kept_log about_log_of(const instance_row& row);

} // namespace roscell
