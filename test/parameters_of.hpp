#pragma once

#include "roscell/skill/parameters.hpp"

#include <nlohmann/json.hpp>

namespace roscell::test {

/// The parameters that a JSON object holds, as a node would tell them.
inline engine::parameters parameters_of(const nlohmann::json& object) {
  return engine::parameters::parse(object.dump());
}

} // namespace roscell::test
