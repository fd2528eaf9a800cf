#pragma once

#include <string>

namespace CLI {
class App;
} // namespace CLI

/// Options that several commands have.
namespace roscell::cli {

/// Adds -o,--output, which sets `output` to "table" or "json".
void add_output_option(CLI::App& command, std::string& output);

/// Adds --timeout. `timeout` holds the default, later what was given, both as
/// `parse_duration` takes it.
void add_timeout_option(CLI::App& command, std::string& timeout);

} // namespace roscell::cli
