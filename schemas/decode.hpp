#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"

#include <exception>
#include <string>
#include <type_traits>
#include <variant>

namespace roscell {

template <class T, class = void>
struct has_message_type : std::false_type {};

template <class T>
struct has_message_type<T, std::void_t<decltype(T::type)>> : std::true_type {};

/// Reads a described struct from a document that has passed its schema. It
/// never throws: what the schema let through and the struct cannot hold comes
/// back as schema_violation, and another message type as unknown_type.
template <class T>
std::variant<T, failure> decode(const json& document) {
  try {
    if constexpr (has_message_type<T>::value)
      if (document.at("type") != T::type)
        return failure{error_code::unknown_type,
                       std::string{"expected a message of type "} + T::type,
                       "/type"};
    T result;
    from_json(document, result);
    return result;
  } catch (const std::exception& error) {
    return failure{error_code::schema_violation,
                   std::string{"cannot be read: "} + error.what()};
  }
}

} // namespace roscell
