#pragma once

#include "messages/codec/json_codec.hpp"

#include <map>
#include <string>
#include <vector>

/// What is derived from the fields of a described struct. It is costly to
/// compile, so each struct has it instantiated once, by ROSCELL_CODEC or, where
/// it has no JSON form, by ROSCELL_DESCRIBED. One that has been forgotten does
/// not link.
namespace roscell {

namespace codec {

inline void put_index(json& j, const char* name, int value) {
  j[name] = value < 0 ? json(nullptr) : json(value);
}

template <class E>
void put_some(json& j, const char* name, const std::vector<E>& values) {
  if (values.size() == 1)
    j[name] = values.front();
  else if (!values.empty())
    j[name] = values;
}

inline void put_raw(json& j, const char* name, const std::string& text) {
  if (!text.empty())
    j[name] = json::parse(text);
}

template <class Field, class T>
void encode_field(json& j, const Field& f, const T& x) {
  if constexpr (Field::kind == presence::nullable)
    put_index(j, f.name, x.*(f.member));
  else if constexpr (Field::kind == presence::one_or_many)
    put_some(j, f.name, x.*(f.member));
  else if constexpr (Field::kind == presence::raw_json)
    put_raw(j, f.name, x.*(f.member));
  else if (Field::kind == presence::required
           || !(x.*(f.member) == T{}.*(f.member)))
    j[f.name] = x.*(f.member);
}

template <class E, class = void>
struct is_made_of_text : std::false_type {};

template <class E>
struct is_made_of_text<E, std::void_t<decltype(E::from_text(""))>>
    : std::true_type {};

/// An element of a list, which may have a short form.
template <class E>
E get_one(const json& j) {
  if constexpr (is_made_of_text<E>::value)
    if (j.is_string())
      return E::from_text(j.get<std::string>());
  return j.get<E>();
}

template <class E>
void get_some(const json& j, std::vector<E>& values) {
  values.clear();
  if (!j.is_array())
    values.push_back(get_one<E>(j));
  else
    for (const auto& x : j)
      values.push_back(get_one<E>(x));
}

template <class Field, class T>
void decode_field(const json& j, const Field& f, T& x) {
  auto i = j.find(f.name);
  if (i == j.end()) {
    if constexpr (Field::kind == presence::required)
      j.at(f.name); // Throws the error that names the missing key.
    return;
  }
  auto& member = x.*(f.member);
  if constexpr (Field::kind == presence::nullable)
    member = i->is_null() ? -1 : i->template get<int>();
  else if constexpr (Field::kind == presence::one_or_many)
    get_some(*i, member);
  else if constexpr (Field::kind == presence::raw_json)
    member = i->dump();
  else
    i->get_to(member);
}

} // namespace codec

template <class T, class>
void to_json(json& j, const T& x) {
  j = json::object();
  for_each_field<T>([&](const auto& f) { codec::encode_field(j, f, x); });
}

template <class T, class>
void from_json(const json& j, T& x) {
  for_each_field<T>([&](const auto& f) { codec::decode_field(j, f, x); });
}

template <class T, class>
bool operator==(const T& x, const T& y) {
  bool result = true;
  for_each_field<T>([&](const auto& f) {
    result = result && x.*(f.member) == y.*(f.member);
  });
  return result;
}

} // namespace roscell

// A type cannot stand in parentheses.
// NOLINTBEGIN(bugprone-macro-parentheses)
#define ROSCELL_DESCRIBED(T) template bool operator==(const T&, const T&);

#define ROSCELL_CODEC(T)                                                       \
  ROSCELL_DESCRIBED(T)                                                         \
  template void to_json(json&, const T&);                                      \
  template void from_json(const json&, T&);
// NOLINTEND(bugprone-macro-parentheses)
