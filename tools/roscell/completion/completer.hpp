#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace roscell::cli {

/// What a word that is being typed may become.
struct completions {
  size_t begin = 0;               ///< Byte of the line where the word begins.
  std::vector<std::string> words; ///< In order; as they are, without quotes.
  bool goes_on = false;           ///< No blank behind it: a folder, a "key=".
  std::string paths; ///< "files" or "dirs" where the words are such.
  std::map<std::string, std::string> meanings; ///< Of some of the words.
};

/// Gives the names of a kind of things: "nodes", "tasks", ...
using name_lookup =
    std::function<std::vector<std::string>(const std::string& kind)>;

/// Completes the last word of a line, by the commands of `app` and what their
/// options and arguments take.
completions complete(const CLI::App& app, std::string_view line,
                     const name_lookup& names);

/// What all words begin with, in whole characters.
std::string common_beginning(const std::vector<std::string>& words);

/// What takes the place of the word that is typed: what is certain of it, in
/// quotes where it needs them, and with a blank behind a whole word.
std::string replacement(const completions& found);

/// What may follow an option, or stand as an argument: "words" and a list,
/// "files" and "dirs" for paths, "ids" and a kind of which the node is asked,
/// "interfaces", "capacity", "commands" or "nothing".
std::string action_of(const CLI::Option& option);

/// All names of an option, with their dashes; the long one last.
std::vector<std::string> names_of(const CLI::Option& option);

/// All names of a command, the one that help shows first.
std::vector<std::string> names_of(const CLI::App& command);

} // namespace roscell::cli
