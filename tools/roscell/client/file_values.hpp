#pragma once

#include "schemas/reading/variables.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
} // namespace CLI

namespace roscell::cli {

/// What a command line gives for the variables of its file.
struct file_values {
  std::vector<std::string> set;   ///< "NAME=VALUE".
  std::vector<std::string> files; ///< Of values; later ones count more.

  /// Reads the files. Throws command_error for one that cannot be read or is
  /// no object, and for what is no NAME=VALUE.
  given_values read() const;
};

/// Adds --set and --values.
void add_value_options(CLI::App& command, file_values& values);

/// The document of a file with its variables filled in, as
/// `fill_variables` says.
std::variant<json, failure> fill_from(json document, const file_values& values);

} // namespace roscell::cli
