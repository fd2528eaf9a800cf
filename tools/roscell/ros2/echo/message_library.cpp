#include "tools/roscell/ros2/echo/message_library.hpp"

#include <fstream>
#include <sstream>
#include <utility>

namespace roscell::cli {

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
