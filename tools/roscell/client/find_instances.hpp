#pragma once

#include "messages/instance.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// The instances that `word` means: the one of that id, else all of the task of
/// that name, else the only one whose id begins so. Throws command_error that
/// names what was probably meant, or which ones begin so.
std::vector<instance_row> find_instances(const std::vector<instance_row>& known,
                                         const std::string& word);

} // namespace roscell::cli
