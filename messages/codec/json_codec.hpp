#pragma once

#include "messages/codec/described.hpp"

#include <nlohmann/json.hpp>

#include <string>

/// JSON from and to described structs. Decoding expects a document that has
/// passed its schema; on any other it throws nlohmann::json::exception.
namespace roscell {

using json = nlohmann::json;

/// Both are defined in messages/codec/instantiate.hpp, which only the few files
/// see that instantiate them.
template <class T, class = if_described<T>>
void to_json(json& j, const T& x);
template <class T, class = if_described<T>>
void from_json(const json& j, T& x);

/// The JSON form of a message: its fields and its `"type"`.
template <class T>
json message_json(const T& x) {
  json j;
  to_json(j, x);
  j["type"] = T::type;
  return j;
}

} // namespace roscell
