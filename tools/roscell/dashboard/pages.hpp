#pragma once

#include "roscell/web_page.hpp"

namespace roscell::cli {

/// The dashboard, from the files of tools/dashboard.
const web_pages& dashboard_pages();

} // namespace roscell::cli
