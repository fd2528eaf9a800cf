#pragma once

#include "tools/roscell/view/table.hpp"

#include <string>

namespace CLI {
class App;
} // namespace CLI

/// Options that several commands have.
namespace roscell::cli {

/// Adds -o,--output, which sets `output` to "table" or "json".
void add_output_option(CLI::App& command, std::string& output);

/// The same with "wide": tables have all columns.
void add_wide_output_option(CLI::App& command, std::string& output);

/// The same for what has no end: "table", "json" or "jsonl", which are one.
void add_stream_output_option(CLI::App& command, std::string& output);

/// Adds -o, --no-headers, --columns and --sort of a command that lists
/// something. -o sets `output` to "table", "wide", "json" or "jsonl".
void add_table_options(CLI::App& command, std::string& output,
                       table_options& tables);

/// Adds --timeout. `timeout` holds the default, later what was given, both as
/// `parse_duration` takes it.
void add_timeout_option(CLI::App& command, std::string& timeout);

} // namespace roscell::cli
