#pragma once

#include "messages/failure.hpp"
#include "messages/instance.hpp"
#include "messages/kept_log.hpp"

#include <string>

/// What is said of instances to people.
namespace roscell {

/// "with exit code 3", "by signal 9", or "in an unknown way" for a negative
/// one.
std::string exit_words(int code);

/// The last bytes of a text, beginning with a whole line where there is one.
std::string last_bytes(const std::string& text, size_t max_bytes);

/// Why an ended instance does not run, for whoever has asked for it:
/// engine_failed with details, or conflict if it was stopped on purpose.
failure deployment_failure(const instance_row& row);

/// With what the log of an instance's last run is kept.
kept_log about_log_of(const instance_row& row);

} // namespace roscell
