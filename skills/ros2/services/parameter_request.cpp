#include "skills/ros2/services/parameter_request.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/rcl_interfaces.hpp"
#include "skills/ros2/services/parameter_answers.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace roscell::ros2 {

namespace {

using nlohmann::json;
using namespace rcl_interfaces;
using type_word = parameter_type;

/// JSON knows numbers only that are finite, and text that is UTF-8.
bool is_json(const json& x) {
  if (x.is_number_float())
    return std::isfinite(x.get<double>());
  if (x.is_array())
    return std::all_of(x.begin(), x.end(), is_json);
  try {
    return !x.dump().empty();
  } catch (const json::exception&) {
    return false;
  }
}

/// None for what JSON has no form of, such as bytes.
std::optional<json> to_json(const parameter_value& x) {
  json result;
  switch (x.type) {
  case type_word::PARAMETER_BOOL:
    result = x.bool_value;
    break;
  case type_word::PARAMETER_INTEGER:
    result = x.integer_value;
    break;
  case type_word::PARAMETER_DOUBLE:
    result = x.double_value;
    break;
  case type_word::PARAMETER_STRING:
    result = x.string_value;
    break;
  case type_word::PARAMETER_BOOL_ARRAY:
    result = x.bool_array_value;
    break;
  case type_word::PARAMETER_INTEGER_ARRAY:
    result = x.integer_array_value;
    break;
  case type_word::PARAMETER_DOUBLE_ARRAY:
    result = x.double_array_value;
    break;
  case type_word::PARAMETER_STRING_ARRAY:
    result = x.string_array_value;
    break;
  default:
    return std::nullopt;
  }
  return is_json(result) ? std::optional{result} : std::nullopt;
}

set_parameters_result result_of(const std::string& problem) {
  return {problem.empty(), problem};
}

} // namespace

parameter_request::parameter_request(std::string_view request, bool all_or_none,
                                     const json& declared, const json& values)
    : all_or_none_(all_or_none) {
  auto wanted = deserialize<set_parameters_request>(request).parameters;
  wanted.resize(std::min(wanted.size(), parameter_answers::most_names));
  auto changes = json::object();
  bool is_whole = true;
  for (const auto& x : wanted) {
    auto& problem = problems_.emplace_back();
    const auto value = to_json(x.value);
    if (!declared.contains(x.name))
      problem = values.contains(x.name)
                    ? "it cannot be changed while the skill runs"
                    : "there is no such parameter";
    else if (!value)
      problem = "a value of this type cannot be set";
    else
      changes[x.name] = *value;
    is_whole = is_whole && problem.empty();
  }
  if (!changes.empty() && (is_whole || !all_or_none))
    changes_ = changes.dump();
}

std::string parameter_request::reply(const std::string& problem) const {
  if (all_or_none_) {
    const auto first =
        std::find_if(problems_.begin(), problems_.end(),
                     [](const std::string& x) { return !x.empty(); });
    return serialize(set_parameters_atomically_response{
        result_of(first == problems_.end() ? problem : *first)});
  }
  set_parameters_response reply;
  for (const auto& own : problems_)
    reply.results.push_back(result_of(own.empty() ? problem : own));
  return serialize(reply);
}

} // namespace roscell::ros2
