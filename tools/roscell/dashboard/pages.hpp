#pragma once

#include "roscell/web_page.hpp"

#include <string>

namespace roscell::cli {

/// The dashboard: the files of tools/dashboard, and what it is told of this
/// program's own.
const web_pages& dashboard_pages();

/// The files of tools/dashboard alone.
const web_pages& page_files();

/// A script that exports COLUMNS, in which things of a kind are listed, and
/// STALE, which answers of the node an event makes old: as this program has
/// them itself.
const std::string& described_script();

} // namespace roscell::cli
