#pragma once

#include "tools/roscell/completion/completer.hpp"

#include <string>
#include <string_view>

namespace roscell::cli {

/// The script with which bash, zsh or fish completes commands of `roscell`: it
/// asks `roscell completion --line` for the words.
std::string completion_script(const std::string& shell);

/// For such a script: in each line what the last word of `line` may become, a
/// tab and what that means. ":files" or ":dirs" stands for paths, which shells
/// find themselves, ":more" says that no blank follows. A name that is no plain
/// word is left out: a shell would expand it.
std::string completion_lines(const CLI::App& app, std::string_view line,
                             const name_lookup& names);

} // namespace roscell::cli
