#pragma once

#include <string>

namespace CLI {
class App;
} // namespace CLI

namespace roscell::cli {

/// A bash script that completes the commands and options of `app`, its files
/// and directories, and the ids of tasks and instances, for which it asks the
/// node quietly.
std::string bash_completion(const CLI::App& app);

} // namespace roscell::cli
