#pragma once

#include <string>

namespace roscell {

/// Whether the text can be an instance's id: it names folders and containers,
/// so it has letters, digits, '_', '-' and '.' only and does not begin with a
/// dot.
bool is_instance_id(const std::string& text);

} // namespace roscell
