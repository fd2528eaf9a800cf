#pragma once

#include "messages/codec/described.hpp"

#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

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

// Enumerations that are words in JSON. Such an enum starts at 0 and has, in
// its namespace, a function that gives its words in order:
//
//     constexpr auto enum_words(row_state) {
//       return std::array<std::string_view, 2>{"reserved", "active"};
//     }

/// `R` if `E` is such an enumeration.
template <class E, class R = void>
using if_worded = std::enable_if_t<
    std::is_enum_v<E> && (decltype(enum_words(E{})){}.size() > 0), R>;

template <class E, class = if_worded<E>>
std::string_view to_word(E value) {
  return enum_words(E{}).at(static_cast<size_t>(value));
}

template <class E, class = if_worded<E>>
std::string to_string(E value) {
  return std::string{to_word(value)};
}

template <class E>
if_worded<E> to_json(json& j, E value) {
  j = to_string(value);
}

/// Throws std::invalid_argument for a word that is none of the enum's.
template <class E>
if_worded<E> from_json(const json& j, E& value) {
  const auto words = enum_words(E{});
  const auto& text = j.get_ref<const std::string&>();
  for (size_t i = 0; i < words.size(); ++i) {
    if (words[i] == text) {
      value = static_cast<E>(i);
      return;
    }
  }
  throw std::invalid_argument{"unknown word '" + text + "'"};
}

} // namespace roscell
