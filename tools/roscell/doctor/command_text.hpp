#pragma once

#include "tools/roscell/split_words.hpp"

#include <sys/types.h>

#include <cstddef>
#include <string>

/// Commands that are shown to be pasted into a shell. Names in them are
/// `shell_word`s: they come from folders that every user may write to, from
/// other hosts and from ROS 2 programs.
namespace roscell::cli {

/// The same command, for another host than the one where it is pasted.
std::string on_host(const std::string& address, const std::string& command);

/// What runs the remedies of a check: a command of many files fills screens.
/// @param doctor the command that finds them again, "roscell doctor --to ADDR".
std::string remedies_of(const std::string& doctor, const std::string& check);

/// Remedies that are longer are had by `remedies_of`.
constexpr size_t longest_remedy = 400;

/// A user, as a word.
std::string user_word(uid_t id);

/// The user of this process, as a word: who pastes may be another one.
std::string own_user();

} // namespace roscell::cli
