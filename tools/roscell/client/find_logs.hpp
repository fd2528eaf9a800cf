#pragma once

#include "messages/kept_log.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// The kept logs that `word` means: the newest of the instance of that id, else
/// of the task of that name the newest of each step, else the newest of the
/// only instance whose id begins so. None if there is none of these. Throws
/// command_error that names which ones begin so.
/// @param known with the newest first.
std::vector<kept_log> find_kept_logs(const std::vector<kept_log>& known,
                                     const std::string& word);

/// "i on node belt: stopped 5m02s ago (removed)".
std::string kept_log_text(const kept_log& log, int64_t now_unix_ms);

} // namespace roscell::cli
