#pragma once

#include "messages/kept_log.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>

namespace roscell::cli {

/// The logs of instances that are gone, and below them what is missing.
std::string kept_logs_view(const kept_logs& logs, const view_style& style);

} // namespace roscell::cli
