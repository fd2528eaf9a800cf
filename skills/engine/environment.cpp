#include "roscell/skill/environment.hpp"

#include "roscell/skill/errors.hpp"

#include <nlohmann/json.hpp>

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string_view>

namespace roscell::engine {

namespace {

using nlohmann::json;

constexpr std::size_t max_streams = 64;

/// Said with every complaint about a variable, because only people who start
/// a skill by hand meet one.
constexpr auto remedy = " (a node sets it; by hand, see skills/README.md)";

std::string optional_text(const variable_lookup& lookup, const char* name) {
  const auto* value = lookup(name);
  return value != nullptr ? value : "";
}

std::string required_text(const variable_lookup& lookup, const char* name) {
  auto value = optional_text(lookup, name);
  if (value.empty())
    throw start_error(std::string{name} + " is not set" + remedy);
  return value;
}

json parse_json(const char* name, const std::string& text) {
  try {
    return json::parse(text);
  } catch (const json::parse_error& e) {
    throw start_error(std::string{name} + " is not JSON, see its byte "
                      + std::to_string(e.byte) + remedy);
  }
}

std::string text_member(const json& object, const char* key,
                        const std::string& place) {
  auto i = object.find(key);
  if (i == object.end() || !i->is_string()
      || i->get_ref<const std::string&>().empty())
    throw start_error(place + " must have a text \"" + key + "\"" + remedy);
  return i->get<std::string>();
}

std::vector<stream> read_streams(const variable_lookup& lookup,
                                 const char* name, std::size_t least) {
  auto list = parse_json(name, required_text(lookup, name));
  if (!list.is_array() || list.size() < least || list.size() > max_streams)
    throw start_error(std::string{name} + " must be a JSON array of "
                      + std::to_string(least) + " to "
                      + std::to_string(max_streams) + " streams" + remedy);
  std::vector<stream> result;
  for (const auto& entry : list) {
    auto place = name + ("[" + std::to_string(result.size())) + "]";
    if (!entry.is_object())
      throw start_error(place + " must be a JSON object" + remedy);
    result.push_back({text_member(entry, "protocol", place),
                      text_member(entry, "endpoint", place),
                      text_member(entry, "data_type", place)});
  }
  return result;
}

std::optional<std::uint64_t> read_number(const variable_lookup& lookup,
                                         const char* name, std::uint64_t least,
                                         std::uint64_t most) {
  auto text = optional_text(lookup, name);
  if (text.empty())
    return std::nullopt;
  std::uint64_t value = 0;
  const auto* end = text.data() + text.size();
  auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || rest != end || value < least || value > most)
    throw start_error(std::string{name} + " must be a whole number from "
                      + std::to_string(least) + " to " + std::to_string(most)
                      + remedy);
  return value;
}

parameters read_parameters(const std::string& text) {
  try {
    return parameters::parse(text);
  } catch (const start_error& e) {
    throw start_error(e.what() + std::string{remedy});
  }
}

} // namespace

environment read_environment(const variable_lookup& lookup) {
  environment result;
  result.task = optional_text(lookup, "ROSCELL_TASK");
  result.step = optional_text(lookup, "ROSCELL_STEP");
  result.instance = optional_text(lookup, "ROSCELL_INSTANCE");
  result.operation = optional_text(lookup, "ROSCELL_OPERATION");
  result.deployment = optional_text(lookup, "ROSCELL_DEPLOYMENT");
  result.secrets_folder = optional_text(lookup, "ROSCELL_SECRETS");
  result.model = required_text(lookup, "ROSCELL_MODEL");
  result.inputs = read_streams(lookup, "ROSCELL_INPUTS", 1);
  result.outputs = read_streams(lookup, "ROSCELL_OUTPUTS", 0);
  if (auto text = optional_text(lookup, "ROSCELL_PARAMETERS"); !text.empty())
    result.parameters = read_parameters(text);
  result.changeable = optional_text(lookup, "ROSCELL_CHANGEABLE");
  result.ros2_set_parameters =
      optional_text(lookup, "ROSCELL_ROS2_SET_PARAMETERS") == "1";
  if (auto gpu = read_number(lookup, "ROSCELL_GPU", 0, 1023))
    result.gpu = static_cast<unsigned>(*gpu);
  result.notify_socket = optional_text(lookup, "NOTIFY_SOCKET");
  // One day is far above any sensible period and far below an overflow.
  auto usec = read_number(lookup, "WATCHDOG_USEC", 1000, 86'400'000'000);
  if (usec)
    result.watchdog = std::chrono::microseconds{*usec};
  result.health = optional_text(lookup, "ROSCELL_HEALTH") == "1";
  return result;
}

std::string environment::secret(const std::string& name) const {
  // As much as a node takes.
  constexpr std::size_t most_bytes = 64 * 1024;
  const auto refuse = [&name](const std::string& why) {
    throw start_error("the secret '" + name + "' " + why);
  };
  if (secrets_folder.empty() || name.empty() || name[0] == '.'
      || name.find('/') != std::string::npos)
    refuse("is not given to this step: name it in the step's \"secrets\"");
  std::ifstream file{secrets_folder + '/' + name, std::ios::binary};
  if (!file)
    refuse("is not given to this step: name it in the step's \"secrets\"");
  std::string result(most_bytes + 1, '\0');
  file.read(result.data(), static_cast<std::streamsize>(result.size()));
  result.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad() || result.size() > most_bytes)
    refuse("cannot be read, or is longer than 64 KiB");
  return result;
}

environment read_environment() {
  return read_environment(
      [](const char* name) -> const char* { return std::getenv(name); });
}

} // namespace roscell::engine
