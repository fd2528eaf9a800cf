#pragma once

#include "tools/roscell/client/node_client.hpp"

#include <istream>

namespace roscell::cli {

/// Does what the lines say, one after the other, until one fails, or to the end
/// with `keep_going`; then that is said with the line's number. Empty lines and
/// those that begin with # say nothing. Returns the exit code of the first that
/// failed.
int run_script(std::istream& lines, const connection_options& connection,
               bool keep_going);

} // namespace roscell::cli
