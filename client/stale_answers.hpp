#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roscell {

/// Which answers of a node an event makes old: its name, or with "*" at the end
/// what that begins with, and the answers: "cell", "cells", "skills", "node",
/// "task" (the one that the event is of). Where several fit the first counts;
/// who follows a cell, here or in a browser, asks for these again.
using stale_list =
    std::vector<std::pair<std::string, std::vector<std::string>>>;

const stale_list& stale_answers();

/// Those that an event of that name makes old; empty for one that says all that
/// there is to know.
const std::vector<std::string>& stale_after(std::string_view what);

} // namespace roscell
