#pragma once

#include "schemas/checks/place.hpp"

namespace roscell::checks {

/// A skill's descriptor as a member registers it.
void check_descriptor(error_list& errors, const place& skill);

/// As an author writes it. What a member registers has been looked at when it
/// read the file.
void check_written_descriptor(error_list& errors, const place& skill);

} // namespace roscell::checks
