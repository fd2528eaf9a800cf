#pragma once

#include "tools/roscell/doctor/check.hpp"
#include "tools/roscell/view/table.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// Whether the terminal's characters are those of UTF-8, by the locale.
bool locale_is_utf8();

/// A table for each area; below them what is not as it should be, with why it
/// matters and the command that fixes it; and a sum.
/// @param signs ✓ ! ✗ instead of words.
/// @param doctor the command that finds the same again.
std::string findings_view(const findings& all, const text_style& style,
                          bool signs,
                          const std::string& doctor = "roscell doctor");

/// What there is to be checked.
std::string checks_view(const std::vector<check>& all, const text_style& style);

} // namespace roscell::cli
