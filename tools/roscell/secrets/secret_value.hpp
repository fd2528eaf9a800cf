#pragma once

#include <string>

namespace roscell::cli {

/// Where the value of a secret comes from: never from a command line, which
/// everybody on a host can read.
struct value_origin {
  std::string file;          ///< Empty: standard input.
  bool keep_newline = false; ///< Of standard input: what it ends with counts.
};

/// The value. At a terminal it is asked for twice, and not shown. One line end
/// at the end of standard input is dropped, which `echo` and a heredoc put
/// there. Throws command_error where it cannot be read, is empty or too long,
/// or was not typed twice.
std::string read_secret_value(const std::string& name,
                              const value_origin& from);

} // namespace roscell::cli
