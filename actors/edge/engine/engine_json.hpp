#pragma once

#include <nlohmann/json.hpp>

#include <string>

/// INTERNAL to this folder: what comes as JSON, and may be anything.
namespace roscell {

/// A text of an object; empty: there is none of that name.
std::string text_in(const nlohmann::json& object, const char* name);

} // namespace roscell
