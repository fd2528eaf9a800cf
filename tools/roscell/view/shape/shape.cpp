#include "tools/roscell/view/shape/shape.hpp"

#include "actors/edge/io/node_time.hpp"

#include <string>

namespace roscell::cli {

namespace {

constexpr std::string_view time_suffix = "_unix_ms";

bool is_time(std::string_view name) {
  return name.size() > time_suffix.size()
         && name.substr(name.size() - time_suffix.size()) == time_suffix;
}

json shaped_time(const json& x) {
  if (x.is_array()) {
    auto result = json::array();
    for (const auto& one : x)
      result.push_back(shaped_time(one));
    return result;
  }
  if (!x.is_number_integer() || x.get<int64_t>() == 0)
    return nullptr;
  return iso_time(x.get<int64_t>());
}

/// The text at a path of members; null if there is none.
json text_at(const json& x, std::initializer_list<const char*> path) {
  const auto* at = &x;
  for (const auto* name : path) {
    const auto found = at->is_object() ? at->find(name) : at->end();
    if (!at->is_object() || found == at->end())
      return nullptr;
    at = &*found;
  }
  return at->is_string() ? *at : json{};
}

/// What names a thing: of a node its identity, of an instance its id, and so
/// on. Null: it is none, or has its name already.
json name_of(const json& x) {
  if (x.contains("name"))
    return nullptr;
  for (const auto& path :
       {std::initializer_list<const char*>{"identity", "name"},
        {"spec", "instance"},
        {"skill", "descriptor", "operation"},
        {"descriptor", "operation"},
        {"transfer"}})
    if (auto name = text_at(x, path); !name.is_null())
      return name;
  if (x.contains("submitted_unix_ms"))
    return text_at(x, {"task"});
  if (x.contains("writers"))
    return text_at(x, {"topic"});
  return x.contains("discovery_server") ? text_at(x, {"cell"}) : json{};
}

/// `input` and `output` of a step are one end or a list of them; those of a
/// descriptor are an object of their own.
bool is_one_end(const std::string& name, const json& x) {
  return (name == "input" || name == "output") && x.is_object()
         && x.contains("endpoint");
}

/// Members in which anybody may have any names.
bool is_free_form(const std::string& name) {
  return name == "parameters" || name == "labels" || name == "environment"
         || name == "data";
}

} // namespace

json shaped(const json& reported) {
  if (reported.is_array()) {
    auto result = json::array();
    for (const auto& x : reported)
      result.push_back(shaped(x));
    return result;
  }
  if (!reported.is_object())
    return reported;
  auto result = json::object();
  if (auto name = name_of(reported); !name.is_null())
    result["name"] = std::move(name);
  for (const auto& [name, value] : reported.items()) {
    if (is_time(name))
      result[name.substr(0, name.size() - time_suffix.size())] =
          shaped_time(value);
    else if (is_one_end(name, value))
      result[name] = json::array({shaped(value)});
    else
      result[name] = is_free_form(name) ? value : shaped(value);
  }
  return result;
}

json shaped_list(const json& reply, const reply_parts& parts) {
  auto result = json::array();
  if (parts.front().empty()) {
    result.push_back(shaped(reply));
    // The name of a message is no part of a thing.
    result[0].erase("type");
  }
  for (const auto part : parts)
    if (const auto list = reply.find(std::string{part}); list != reply.end())
      for (const auto& x : *list)
        result.push_back(shaped(x));
  return result;
}

} // namespace roscell::cli
