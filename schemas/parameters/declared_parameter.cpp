#include "schemas/parameters/declared_parameter.hpp"

#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace roscell {

namespace {

const char* type_of(const json& value) {
  switch (value.type()) {
  case json::value_t::boolean:
    return "boolean";
  case json::value_t::string:
    return "string";
  case json::value_t::array:
    return "array";
  case json::value_t::object:
    return "object";
  case json::value_t::null:
    return "";
  default:
    return "number";
  }
}

/// A default of 1 does not say that 1.5 is wrong, so it is a number.
bool has_type(const declared_parameter& x, const json& value) {
  if (x.type == "integer")
    return value.is_number_integer();
  return x.type.empty() || x.type == type_of(value);
}

bool has_item_type(const std::string& type, const json& item) {
  return type == "integer" ? item.is_number_integer() : type == type_of(item);
}

bool has_items(const declared_parameter& x, const json& value) {
  return x.items.empty() || !value.is_array()
         || std::all_of(value.begin(), value.end(), [&](const json& item) {
              return has_item_type(x.items, item);
            });
}

bool is_in_range(const declared_parameter& x, const json& value) {
  if (!value.is_number())
    return true;
  const auto number = value.get<double>();
  return number >= x.minimum && number <= x.maximum;
}

bool is_listed(const declared_parameter& x, const json& value) {
  return x.values.empty()
         || std::find(x.values.begin(), x.values.end(), value)
                != x.values.end();
}

/// "a list of numbers"
std::string list_text(const std::string& items) {
  if (items.empty())
    return "a list";
  return "a list of " + (items == "string" ? "text" : items) + "s";
}

std::string type_text(const std::string& type) {
  static constexpr std::array<std::pair<const char*, const char*>, 6> words{
      {{"boolean", "true or false"},
       {"integer", "an integer"},
       {"number", "a number"},
       {"string", "a text"},
       {"array", "a list"},
       {"object", "an object"}}};
  for (const auto& [name, text] : words)
    if (type == name)
      return text;
  return "a value";
}

declared_parameter read_declaration(const json& x) {
  declared_parameter result;
  result.type = x.value("type", "");
  result.value = x.value("default", json{});
  result.minimum = x.value("minimum", result.minimum);
  result.maximum = x.value("maximum", result.maximum);
  result.values = x.value("values", result.values);
  result.unit = x.value("unit", "");
  result.description = x.value("description", "");
  result.changeable = x.value("changeable", false);
  result.items = x.value("items", "");
  result.is_declared = true;
  return result;
}

} // namespace

declared_parameters read_parameters(const json& parameters,
                                    const declared_parameters& known) {
  auto result = known;
  for (const auto& [name, x] : parameters.items()) {
    if (x.is_object())
      result[name] = read_declaration(x);
    else if (known.count(name) > 0)
      result[name].value = x;
    else
      result[name] = {type_of(x), x};
  }
  return result;
}

std::string parameter_text(const declared_parameter& x) {
  if (!x.values.empty()) {
    std::string result = "one of";
    for (const auto& value : x.values)
      result += (&value == &x.values.front() ? " " : ", ") + value.dump();
    return result;
  }
  return (x.type == "array" ? list_text(x.items) : type_text(x.type))
         + bounds_text(x.minimum, x.maximum)
         + (x.unit.empty() ? "" : " (" + x.unit + ")");
}

std::string value_problem(const declared_parameter& x, const json& value) {
  if (has_type(x, value) && has_items(x, value) && is_in_range(x, value)
      && is_listed(x, value))
    return {};
  return "expected " + parameter_text(x) + ", got " + shown_value(value);
}

std::vector<schema_error> declaration_errors(const json& parameters,
                                             const std::string& place) {
  std::vector<schema_error> result;
  for (const auto& [name, x] : parameters.items()) {
    if (!x.is_object())
      continue;
    const auto at = (json::json_pointer{place} / name).to_string();
    const auto declared = read_declaration(x);
    if (declared.minimum > declared.maximum)
      result.push_back({at + "/minimum", "expected at most the maximum, got "
                                             + shown_value(x["minimum"])});
    if (!declared.items.empty() && declared.type != "array")
      result.push_back(
          {at + "/items", "expected \"type\": \"array\" beside it, "
                          "got "
                              + shown_value(x["type"])});
    if (declared.value.is_null())
      continue;
    if (auto problem = value_problem(declared, declared.value);
        !problem.empty())
      result.push_back({at + "/default", std::move(problem)});
  }
  return result;
}

json step_parameters(const std::string& model, const std::string& step) {
  auto result =
      model.empty() ? json::object() : parameter_defaults(json::parse(model));
  if (!step.empty())
    result.update(json::parse(step));
  return result;
}

json parameter_defaults(const json& parameters) {
  auto result = json::object();
  for (const auto& [name, x] : read_parameters(parameters))
    if (!x.value.is_null())
      result[name] = x.value;
  return result;
}

} // namespace roscell
