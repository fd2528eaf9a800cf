#include "actors/edge/engine/engine_json.hpp"

namespace roscell {

std::string text_in(const nlohmann::json& object, const char* name) {
  const auto i = object.find(name);
  return i != object.end() && i->is_string() ? i->get<std::string>()
                                             : std::string{};
}

} // namespace roscell
