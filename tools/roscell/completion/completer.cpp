#include "tools/roscell/completion/completer.hpp"

#include "tools/roscell/split_words.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

/// A word that is offered, and what it means, where that is said.
struct offer {
  std::string word;
  std::string meaning = {};
};

using offer_list = std::vector<offer>;

std::vector<const CLI::App*> commands_below(const CLI::App& app) {
  return app.get_subcommands(
      [](const CLI::App* x) { return !x->get_name().empty(); });
}

offer_list command_names(const CLI::App& app) {
  offer_list result;
  for (const auto* command : commands_below(app))
    result.push_back({command->get_name(), command->get_description()});
  return result;
}

offer_list option_names(const CLI::App& command) {
  offer_list result;
  for (const auto* option : command.get_options())
    if (!option->get_positional())
      for (auto& name : names_of(*option))
        result.push_back({std::move(name), option->get_description()});
  return result;
}

offer_list without_meanings(const std::vector<std::string>& words) {
  offer_list result;
  for (const auto& x : words)
    result.push_back({x});
  return result;
}

/// The files, or the folders only, that a path may become. A folder ends with
/// a slash.
std::vector<std::string> paths_of(const std::string& begun, bool only_folders) {
  const auto slash = begun.rfind('/');
  const auto folder =
      slash == begun.npos ? std::string{} : begun.substr(0, slash + 1);
  std::vector<std::string> result;
  std::error_code problem;
  const fs::path where = folder.empty() ? "." : folder;
  for (fs::directory_iterator i{where, problem}, end; !problem && i != end;
       i.increment(problem)) {
    std::error_code ignored;
    const bool is_folder = i->is_directory(ignored);
    if (is_folder || !only_folders)
      result.push_back(folder + i->path().filename().string()
                       + (is_folder ? "/" : ""));
  }
  return result;
}

std::vector<std::string> interface_names() {
  std::vector<std::string> result;
  std::error_code problem;
  for (fs::directory_iterator i{"/sys/class/net", problem}, end;
       !problem && i != end; i.increment(problem))
    result.push_back(i->path().filename().string());
  return result;
}

/// The words that an action of `action_of` stands for.
class offers {
public:
  offers(const CLI::App& app, const name_lookup& names)
      : app_{app}, names_{names} {}

  offer_list of(const std::string& action, const std::string& begun) {
    const auto blank = action.find(' ');
    const auto kind = action.substr(0, blank);
    const auto rest = blank == action.npos ? "" : action.substr(blank + 1);
    if (kind == "files" || kind == "dirs") {
      paths = kind;
      return without_meanings(paths_of(begun, kind == "dirs"));
    }
    if (kind == "words")
      return without_meanings(split_words(rest).words);
    if (kind == "ids")
      return without_meanings(names_(rest));
    if (kind == "interfaces")
      return without_meanings(interface_names());
    if (kind == "capacity")
      return {{"cpu="}, {"memory_mib="}, {"disk_mib="}};
    return kind == "commands" ? command_names(app_) : offer_list{};
  }

  std::string paths; ///< "files" or "dirs" if there are such.

private:
  const CLI::App& app_;
  const name_lookup& names_;
};

/// What the words before the one that is typed say of it.
struct typed_place {
  const CLI::App* command;
  const CLI::Option* option = nullptr; ///< Whose value it is; null: none.
  size_t argument = 0;                 ///< Arguments before it.
};

const CLI::Option* option_of(const CLI::App& command, const std::string& name) {
  for (const auto* option : command.get_options()) {
    const auto names = names_of(*option);
    if (std::find(names.begin(), names.end(), name) != names.end())
      return option;
  }
  return nullptr;
}

const CLI::App* command_below(const CLI::App& app, const std::string& name) {
  for (const auto* command : commands_below(app))
    if (command->check_name(name))
      return command;
  return nullptr;
}

typed_place place_after(const CLI::App& app,
                        const std::vector<std::string>& before) {
  typed_place place{&app};
  for (const auto& word : before) {
    if (std::exchange(place.option, nullptr) != nullptr)
      continue;
    if (word.size() > 1 && word.front() == '-') {
      const auto* option = option_of(*place.command, word);
      if (option != nullptr && option->get_items_expected_max() != 0)
        place.option = option;
    } else if (const auto* next = command_below(*place.command, word);
               next != nullptr && place.argument == 0) {
      place.command = next;
    } else {
      ++place.argument;
    }
  }
  return place;
}

/// The argument at this place; the last one may be repeated.
const CLI::Option* argument_at(const CLI::App& command, size_t number) {
  const CLI::Option* result = nullptr;
  for (const auto* option : command.get_options()) {
    if (!option->get_positional())
      continue;
    result = option;
    if (number-- == 0)
      break;
  }
  return result;
}

offer_list offered_at(const typed_place& place, const std::string& begun,
                      offers& all) {
  if (place.option != nullptr)
    return all.of(action_of(*place.option), begun);
  if (!begun.empty() && begun.front() == '-')
    return option_names(*place.command);
  auto result =
      place.argument == 0 ? command_names(*place.command) : offer_list{};
  if (const auto* argument = argument_at(*place.command, place.argument)) {
    auto more = all.of(action_of(*argument), begun);
    std::move(more.begin(), more.end(), std::back_inserter(result));
  }
  return result;
}

/// What is to be put before the completed word: the option of `--opt=value`.
std::string take_option(typed_place& place, std::string& begun) {
  const auto equals = begun.find('=');
  if (begun.rfind("--", 0) != 0 || equals == begun.npos)
    return {};
  const auto* option = option_of(*place.command, begun.substr(0, equals));
  if (option == nullptr)
    return {};
  place.option = option;
  auto head = begun.substr(0, equals + 1);
  begun.erase(0, equals + 1);
  return head;
}

} // namespace

completions complete(const CLI::App& app, std::string_view line,
                     const name_lookup& names) {
  auto split = split_words(line);
  std::string begun;
  if (split.in_word) {
    begun = std::move(split.words.back());
    split.words.pop_back();
  }
  auto place = place_after(app, without_program(std::move(split.words)));
  const auto head = take_option(place, begun);
  completions result;
  result.begin = split.last_begin;
  offers all{app, names};
  for (const auto& x : offered_at(place, begun, all))
    if (x.word.rfind(begun, 0) == 0) {
      result.words.push_back(head + x.word);
      result.meanings[head + x.word] = x.meaning;
    }
  result.paths = all.paths;
  std::sort(result.words.begin(), result.words.end());
  result.words.erase(std::unique(result.words.begin(), result.words.end()),
                     result.words.end());
  if (result.words.size() == 1) {
    const char last = result.words.front().back();
    result.goes_on = last == '/' || last == '=';
  }
  return result;
}

std::string common_beginning(const std::vector<std::string>& words) {
  if (words.empty())
    return {};
  auto result = words.front();
  for (const auto& word : words) {
    const auto end =
        std::mismatch(result.begin(), result.end(), word.begin(), word.end());
    result.erase(end.first, result.end());
  }
  // A part of a character is no text.
  const auto& whole = words.front();
  while (!result.empty() && result.size() < whole.size()
         && (whole[result.size()] & 0xc0) == 0x80)
    result.pop_back();
  return result;
}

std::string replacement(const completions& found) {
  const auto certain = common_beginning(found.words);
  if (certain.empty())
    return {};
  const bool is_whole = found.words.size() == 1 && !found.goes_on;
  return shell_word(certain) + (is_whole ? " " : "");
}

namespace {

/// What may follow an option or stand as an argument.
struct value_source {
  std::string_view name; ///< Of the option, or of the positional.
  std::string_view action;
};

// `words` takes a list, `files` and `dirs` are paths, `ids` asks the node.
constexpr value_source sources[] = {
    {"--runtime", "words auto docker podman process"},
    {"--log-level", "words trace debug info warn error off"},
    {"--interface", "interfaces"},
    {"--token-file", "files"},
    {"--site-token", "files"},
    {"--socket", "files"},
    {"--config", "files"},
    {"--to", "files"},
    {"--device", "files"},
    {"--file", "files"},
    {"--data-dir", "dirs"},
    {"--skills", "dirs"},
    {"--man-pages", "dirs"},
    {"--capacity", "capacity"},
    {"--instances", "words refuse terminate reschedule"},
    {"FILE", "files"},
    {"NODE", "ids nodes"},
    {"NAME", "ids nodes"},
    {"CELL", "ids cells"},
    {"TRANSFER", "ids transfers"},
    {"TASK", "ids tasks"},
    {"SUBJECT", "ids tasks"},
    {"TASK|INSTANCE", "ids instances"},
    {"INSTANCE", "ids instances"},
    {"SECRET", "ids secrets"},
    {"PARAMETER", "ids parameters"},
    {"SHELL", "words bash zsh fish"},
    {"COMMAND", "commands"},
    {"PROGRAM", "nothing"},
    // The shell alone finds these.
    {"ACTOR", "ids actors"},
    {"KIND", "ids kinds"},
    {"--subject", "ids subjects"},
};

} // namespace

std::string action_of(const CLI::Option& option) {
  const auto name =
      option.get_positional() ? option.get_name(true) : names_of(option).back();
  // Commands differ in the forms that they can print: "table|json [table]".
  if (name == "--output") {
    const auto& text = option.get_option_text();
    auto words = text.substr(0, text.find(' '));
    std::replace(words.begin(), words.end(), '|', ' ');
    return "words " + words;
  }
  for (const auto& source : sources)
    if (source.name == name)
      return std::string{source.action};
  return "nothing";
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const auto& name : option.get_snames())
    names.push_back("-" + name);
  for (const auto& name : option.get_lnames())
    names.push_back("--" + name);
  return names;
}

std::vector<std::string> names_of(const CLI::App& command) {
  std::vector<std::string> names{command.get_name()};
  const auto& others = command.get_aliases();
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

} // namespace roscell::cli
