#include "actors/edge/engine/engine_json.hpp"

namespace roscell {

std::string text_at(const nlohmann::json& object, const char* name) {
  const auto i = object.find(name);
  return i != object.end() && i->is_string() ? i->get<std::string>()
                                             : std::string{};
}

int64_t number_at(const nlohmann::json& object, const char* name,
                  int64_t otherwise) {
  const auto i = object.find(name);
  return i != object.end() && i->is_number_integer() ? i->get<int64_t>()
                                                     : otherwise;
}

bool flag_at(const nlohmann::json& object, const char* name) {
  const auto i = object.find(name);
  return i != object.end() && i->is_boolean() && i->get<bool>();
}

nlohmann::json object_at(const nlohmann::json& object, const char* name) {
  const auto i = object.find(name);
  return i != object.end() && i->is_object() ? *i : nlohmann::json::object();
}

} // namespace roscell
