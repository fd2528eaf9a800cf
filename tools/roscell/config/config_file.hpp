#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

/// A file that says what the command line of a node may say, too.
namespace roscell::cli {

/// The largest file that is read.
constexpr size_t max_config_bytes = 64UL * 1024;

/// "key = value" in a line of its own.
struct config_line {
  size_t number; ///< Counted from 1.
  std::string key;
  std::string value;
};

/// The lines of a file that say something: not empty ones, and nothing that
/// stands behind a '#' at a line's beginning or after a blank. Throws
/// command_error, with `name` and the line, where there is no key or no value.
std::vector<config_line> parse_config(const std::string& name,
                                      const std::string& text);

/// The options of `command` that a file may set.
std::vector<CLI::Option*> options_of_file(CLI::App& command);

/// Sets the options of `command` that the file names and the command line has
/// left out. A path that is not absolute begins in the folder of the file.
/// Throws command_error, with the file and the line, if it is larger than 64
/// KiB, or names what is no option, is given twice, or is no such value.
void take_config(CLI::App& command, const std::filesystem::path& file);

} // namespace roscell::cli

namespace roscell::cli {

/// A file for `--config` of this command that has every option, each commented
/// out below what its help says.
std::string config_template(CLI::App& command);

} // namespace roscell::cli
