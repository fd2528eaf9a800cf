#include "tools/roscell/ros2/echo/message_library.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

namespace roscell::cli {

namespace {

constexpr std::array<std::string_view, 15> primitives{
    "bool",   "byte",  "char",   "float32", "float64",
    "int8",   "uint8", "int16",  "uint16",  "int32",
    "uint32", "int64", "uint64", "string",  "wstring"};

/// More than a message of this length would be no use.
constexpr std::size_t most_items = 1 << 20;

bool is_primitive(const std::string& type) {
  return std::find(primitives.begin(), primitives.end(), type)
         != primitives.end();
}

/// "Header" and "std_msgs/Header" are short for "std_msgs/msg/Header"; the
/// first stands for a message of the same package, but for ROS 1's own.
std::string full_name(const std::string& package, const std::string& type) {
  const auto slash = type.find('/');
  if (slash == std::string::npos)
    return (type == "Header" ? "std_msgs" : package) + "/msg/" + type;
  if (type.find('/', slash + 1) == std::string::npos)
    return type.substr(0, slash) + "/msg/" + type.substr(slash + 1);
  return type;
}

/// "uint8[]", "float64[9]", "string<=5[<=3]".
message_field read_type(const std::string& package, std::string text) {
  message_field result;
  if (const auto open = text.find('['); open != std::string::npos) {
    if (text.back() != ']')
      throw definition_error{"'" + text + "' is no type"};
    const auto count = text.substr(open + 1, text.size() - open - 2);
    text.erase(open);
    result.is_array = true;
    if (!count.empty() && std::isdigit(static_cast<unsigned char>(count[0])))
      result.items = std::stoul(count.substr(0, 8));
    if (result.items > most_items)
      throw definition_error{"an array of " + count + " items is too long"};
  }
  text = text.substr(0, text.find('<'));
  if (text.empty())
    throw definition_error{"there is a field without a type"};
  result.type = is_primitive(text) ? text : full_name(package, text);
  return result;
}

void read_line(const std::string& package, const std::string& line,
               message_definition& to) {
  std::istringstream words{line.substr(0, line.find('#'))};
  std::string type;
  std::string name;
  std::string rest;
  if (!(words >> type))
    return;
  if (!(words >> name))
    throw definition_error{"'" + type + "' has no name"};
  words >> rest;
  const bool is_constant =
      name.find('=') != std::string::npos || rest.substr(0, 1) == "=";
  if (is_constant)
    return;
  auto field = read_type(package, type);
  field.name = name;
  to.push_back(std::move(field));
}

} // namespace

message_definition read_definition(const std::string& package,
                                   const std::string& text) {
  message_definition result;
  std::istringstream lines{text};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    try {
      read_line(package, line, result);
    } catch (const definition_error& why) {
      throw definition_error{"line " + std::to_string(number) + ": "
                             + why.what()};
    }
  }
  return result;
}

namespace {

namespace fs = std::filesystem;

/// A definition is a page of text; what is longer is none.
constexpr std::size_t most_bytes = 1 << 20;

} // namespace

message_library::message_library(std::vector<fs::path> prefixes)
    : prefixes_{std::move(prefixes)} {}

const message_definition& message_library::find(const std::string& type) {
  if (const auto i = known_.find(type); i != known_.end())
    return i->second;
  const auto slash = type.find('/');
  const auto last = type.rfind('/');
  if (slash == std::string::npos || slash == last)
    throw definition_error{"'" + type + "' is no type of a message"};
  const auto package = type.substr(0, slash);
  try {
    return known_[type] = read_definition(
               package, text_of(package, type.substr(last + 1), type));
  } catch (const definition_error& why) {
    known_.erase(type);
    throw definition_error{type + ": " + why.what()};
  }
}

std::string message_library::text_of(const std::string& package,
                                     const std::string& name,
                                     const std::string& type) const {
  const auto& own = embedded_definitions();
  if (const auto i = own.find(type); i != own.end())
    return i->second;
  for (const auto& prefix : prefixes_) {
    std::ifstream file{prefix / "share" / package / "msg" / (name + ".msg")};
    if (!file)
      continue;
    std::string text(most_bytes, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    return text;
  }
  throw definition_error{
      "its definition is not known; source the setup.bash of "
      "the workspace that has it, so that AMENT_PREFIX_PATH "
      "names it"};
}

std::vector<fs::path> prefixes_in(const std::string& list) {
  std::vector<fs::path> result;
  std::istringstream parts{list};
  for (std::string part; std::getline(parts, part, ':');)
    if (!part.empty())
      result.emplace_back(part);
  return result;
}

} // namespace roscell::cli
