#pragma once

#include <string>

namespace CLI {
class App;
} // namespace CLI

namespace roscell::cli {

/// A file for `--config` of this command that has every option, each commented
/// out below what its help says.
std::string config_template(CLI::App& command);

} // namespace roscell::cli
