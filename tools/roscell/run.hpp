#pragma once

namespace roscell::cli {

/// The whole program: parses the command line and does what it says. Returns
/// the exit code (tools/roscell/exit_code.hpp).
int run(int argc, char** argv);

} // namespace roscell::cli
