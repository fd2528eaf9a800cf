#pragma once

#include <string>

namespace roscell::cli {

/// Starts the desktop's browser at an address. False if there is none. The
/// address is not seen in the list of processes: it has a secret.
bool open_page(const std::string& url);

} // namespace roscell::cli
