#pragma once

#include "tools/roscell/top/model/cell_model.hpp"

#include <string_view>

namespace roscell::cli::top {

/// What has to be asked again after an event of that name; nothing where it
/// says all that is shown of it.
questions questions_after(std::string_view what);

} // namespace roscell::cli::top
