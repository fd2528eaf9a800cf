#pragma once

#include <string>

namespace roscell::cli {

/// A word as a shell has to be given it so that it stays one word and nothing
/// in it is expanded; as it is where it may be.
std::string shell_word(const std::string& word);

} // namespace roscell::cli
