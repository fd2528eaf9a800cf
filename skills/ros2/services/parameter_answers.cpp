#include "skills/ros2/services/parameter_answers.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/rcl_interfaces.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace roscell::ros2 {

namespace {

using nlohmann::json;
using namespace rcl_interfaces;
using type_word = parameter_type;

bool are(const json& list, bool (json::*is_it)() const noexcept) {
  return std::all_of(list.begin(), list.end(),
                     [&](const json& x) { return (x.*is_it)(); });
}

std::uint8_t type_of_list(const json& list) {
  if (list.empty() || are(list, &json::is_string))
    return type_word::PARAMETER_STRING_ARRAY;
  if (are(list, &json::is_boolean))
    return type_word::PARAMETER_BOOL_ARRAY;
  if (are(list, &json::is_number_integer))
    return type_word::PARAMETER_INTEGER_ARRAY;
  return are(list, &json::is_number) ? type_word::PARAMETER_DOUBLE_ARRAY
                                     : type_word::PARAMETER_NOT_SET;
}

/// @param declared as in a descriptor, or "": 2 may be a number, too.
std::uint8_t type_of(const json& value, const std::string& declared) {
  if (value.is_boolean())
    return type_word::PARAMETER_BOOL;
  if (value.is_string())
    return type_word::PARAMETER_STRING;
  if (value.is_number_integer() && declared != "number")
    return type_word::PARAMETER_INTEGER;
  if (value.is_number())
    return type_word::PARAMETER_DOUBLE;
  return value.is_array() ? type_of_list(value) : type_word::PARAMETER_NOT_SET;
}

parameter_value to_value(const json& x, std::uint8_t type) {
  parameter_value result;
  result.type = type;
  switch (type) {
  case type_word::PARAMETER_BOOL:
    result.bool_value = x.get<bool>();
    break;
  case type_word::PARAMETER_INTEGER:
    result.integer_value = x.get<std::int64_t>();
    break;
  case type_word::PARAMETER_DOUBLE:
    result.double_value = x.get<double>();
    break;
  case type_word::PARAMETER_STRING:
    result.string_value = x.get<std::string>();
    break;
  case type_word::PARAMETER_BOOL_ARRAY:
    result.bool_array_value = x.get<std::vector<bool>>();
    break;
  case type_word::PARAMETER_INTEGER_ARRAY:
    result.integer_array_value = x.get<std::vector<std::int64_t>>();
    break;
  case type_word::PARAMETER_DOUBLE_ARRAY:
    result.double_array_value = x.get<std::vector<double>>();
    break;
  case type_word::PARAMETER_STRING_ARRAY:
    result.string_array_value = x.get<std::vector<std::string>>();
    break;
  default:
    break;
  }
  return result;
}

json object_in(const std::string& text) {
  auto result = json::parse(text, nullptr, false);
  return result.is_object() ? result : json::object();
}

std::string declared_type(const json& declared, const std::string& name) {
  const auto found = declared.find(name);
  return found == declared.end() ? "" : found->value("type", "");
}

std::uint8_t known_type(const json& values, const json& declared,
                        const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? type_word::PARAMETER_NOT_SET
                               : type_of(*found, declared_type(declared, name));
}

std::vector<std::string> names_in(std::string_view request) {
  auto names = deserialize<names_request>(request).names;
  names.resize(std::min(names.size(), parameter_answers::most_names));
  return names;
}

/// How many levels a name has below the first one.
std::uint64_t depth_of(std::string_view name) {
  return static_cast<std::uint64_t>(std::count(name.begin(), name.end(), '.'));
}

/// Below a prefix, or any where there is none; a depth of 0 is no bound.
bool is_listed(const std::string& name, const list_parameters_request& wanted) {
  const auto is_near = [&](std::string_view rest) {
    return wanted.depth == 0 || depth_of(rest) < wanted.depth;
  };
  if (wanted.prefixes.empty())
    return is_near(name);
  return std::any_of(wanted.prefixes.begin(), wanted.prefixes.end(),
                     [&](const std::string& prefix) {
                       if (name == prefix)
                         return true;
                       const auto begin = prefix + ".";
                       return name.compare(0, begin.size(), begin) == 0
                              && is_near(
                                  std::string_view{name}.substr(begin.size()));
                     });
}

std::string constraints_of(const json& declared) {
  const auto values = declared.find("values");
  return values == declared.end() ? "" : "one of " + values->dump();
}

/// ROS 2 knows ranges with two ends only.
void set_range(const json& declared, parameter_descriptor& to) {
  const auto least = declared.find("minimum");
  const auto most = declared.find("maximum");
  if (least == declared.end() || most == declared.end())
    return;
  if (to.type == type_word::PARAMETER_DOUBLE)
    to.floating_point_range = {{least->get<double>(), most->get<double>(), 0}};
  if (to.type == type_word::PARAMETER_INTEGER && least->is_number_integer()
      && most->is_number_integer())
    to.integer_range = {
        {least->get<std::int64_t>(), most->get<std::int64_t>(), 1}};
}

} // namespace

parameter_answers::parameter_answers(const std::string& declared,
                                     std::string remedy)
    : declared_(object_in(declared)), remedy_(std::move(remedy)) {
  // nop
}

void parameter_answers::set(const std::string& values) {
  const auto given = object_in(values);
  values_ = json::object();
  for (const auto& [name, value] : given.items())
    if (type_of(value, declared_type(declared_, name))
        != type_word::PARAMETER_NOT_SET)
      values_[name] = value;
}

std::string parameter_answers::list(std::string_view request) const {
  const auto wanted = deserialize<list_parameters_request>(request);
  if (wanted.prefixes.size() > most_names)
    throw cdr_error("prefixes", "more of them than anybody needs");
  list_parameters_response reply;
  std::set<std::string> prefixes;
  for (const auto& [name, value] : values_.items()) {
    if (!is_listed(name, wanted))
      continue;
    reply.result.names.push_back(name);
    if (const auto dot = name.rfind('.'); dot != std::string::npos)
      prefixes.insert(name.substr(0, dot));
  }
  reply.result.prefixes.assign(prefixes.begin(), prefixes.end());
  return serialize(reply);
}

std::string parameter_answers::get(std::string_view request) const {
  get_parameters_response reply;
  for (const auto& name : names_in(request)) {
    const auto type = known_type(values_, declared_, name);
    reply.values.push_back(to_value(values_.value(name, json{}), type));
  }
  return serialize(reply);
}

std::string parameter_answers::types(std::string_view request) const {
  get_parameter_types_response reply;
  for (const auto& name : names_in(request))
    reply.types.push_back(known_type(values_, declared_, name));
  return serialize(reply);
}

std::string parameter_answers::describe(std::string_view request) const {
  describe_parameters_response reply;
  for (const auto& name : names_in(request)) {
    parameter_descriptor x;
    x.name = name;
    x.type = known_type(values_, declared_, name);
    const auto declared = declared_.find(name);
    x.read_only = declared == declared_.end();
    if (!x.read_only) {
      x.description = declared->value("description", "");
      x.additional_constraints = constraints_of(*declared);
      set_range(*declared, x);
    }
    reply.descriptors.push_back(std::move(x));
  }
  return serialize(reply);
}

std::string parameter_answers::refuse(std::string_view request) const {
  const auto wanted = deserialize<set_parameters_request>(request);
  set_parameters_response reply;
  reply.results.assign(std::min(wanted.parameters.size(), most_names),
                       {false, remedy_});
  return serialize(reply);
}

std::string parameter_answers::refuse_all(std::string_view request) const {
  deserialize<set_parameters_request>(request);
  return serialize(set_parameters_atomically_response{{false, remedy_}});
}

const std::vector<parameter_service>& parameter_services() {
#define ROSCELL_SERVICE(name, type, answer, kind)                              \
  {                                                                            \
    name, "rcl_interfaces::srv::dds_::" type "_Request_",                      \
        "rcl_interfaces::srv::dds_::" type "_Response_",                       \
        &parameter_answers::answer, parameter_service::kind                    \
  }
  static const std::vector<parameter_service> all{
      ROSCELL_SERVICE("list_parameters", "ListParameters", list, reads),
      ROSCELL_SERVICE("get_parameters", "GetParameters", get, reads),
      ROSCELL_SERVICE("get_parameter_types", "GetParameterTypes", types, reads),
      ROSCELL_SERVICE("describe_parameters", "DescribeParameters", describe,
                      reads),
      ROSCELL_SERVICE("set_parameters", "SetParameters", refuse, sets),
      ROSCELL_SERVICE("set_parameters_atomically", "SetParametersAtomically",
                      refuse_all, sets_all)};
#undef ROSCELL_SERVICE
  return all;
}

} // namespace roscell::ros2
