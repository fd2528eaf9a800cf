#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

/// What engines and their users' files say as JSON, and which may be anything.
namespace roscell {

/// A part of an object; the default if it is not there, or something else.
std::string text_at(const nlohmann::json& object, const char* name);
int64_t number_at(const nlohmann::json& object, const char* name,
                  int64_t otherwise);
bool flag_at(const nlohmann::json& object, const char* name);

/// An object in an object; empty if it is none.
nlohmann::json object_at(const nlohmann::json& object, const char* name);

} // namespace roscell
