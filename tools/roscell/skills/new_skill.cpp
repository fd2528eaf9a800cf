#include "tools/roscell/skills/new_skill.hpp"

#include "messages/codec/json_codec.hpp"

#include <algorithm>
#include <map>
#include <regex>
#include <utility>

namespace roscell::cli {

namespace {

/// As schemas/common.schema.json has it for the name of an operation.
constexpr size_t max_name_characters = 63;

/// A path as YAML reads it, whatever characters it has.
std::string quoted(const std::filesystem::path& path) {
  return json(path.string())
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

void replace_all(std::string& text, const std::string& what,
                 const std::string& by) {
  for (size_t at = 0; (at = text.find(what, at)) != std::string::npos;
       at += by.size())
    text.replace(at, what.size(), by);
}

} // namespace

bool is_skill_name(const std::string& name) {
  static const std::regex words{"[a-z][a-z0-9]*(_[a-z0-9]+)*"};
  return name.size() <= max_name_characters && std::regex_match(name, words);
}

std::string skill_name_for(const std::string& text) {
  std::string result;
  for (const char c : text.substr(0, max_name_characters)) {
    const auto is_upper = c >= 'A' && c <= 'Z';
    const auto is_word = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (is_upper || is_word)
      result += is_upper ? static_cast<char>(c - 'A' + 'a') : c;
    else if (!result.empty() && result.back() != '_')
      result += '_';
  }
  while (!result.empty() && result.back() == '_')
    result.pop_back();
  return is_skill_name(result) ? result : std::string{};
}

std::vector<new_file> skill_files(const std::string& name,
                                  const std::filesystem::path& folder) {
  const std::map<std::string, std::string> known{
      {"@NAME@", name},
      {"@INPUT@", quoted(folder / "test/frames.txt")},
      {"@OUTPUT@", quoted(folder / "build/results.txt")}};
  auto result = embedded_template();
  for (auto& file : result) {
    replace_all(file.path, "NAME", name);
    for (const auto& [word, value] : known)
      replace_all(file.text, word, value);
  }
  return result;
}

} // namespace roscell::cli
