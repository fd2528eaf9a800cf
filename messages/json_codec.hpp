#pragma once

#include "messages/described.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <vector>

/// JSON from and to described structs. Decoding expects a document that has
/// passed its schema; on any other it throws nlohmann::json::exception.
namespace roscell {

using json = nlohmann::json;

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

template <class E>
void get_some(const json& j, std::vector<E>& values) {
  if (j.is_array())
    values = j.get<std::vector<E>>();
  else
    values.assign(1, j.get<E>());
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

template <class T, class = if_described<T>>
void to_json(json& j, const T& x) {
  j = json::object();
  for_each_field<T>([&](const auto& f) { codec::encode_field(j, f, x); });
}

template <class T, class = if_described<T>>
void from_json(const json& j, T& x) {
  for_each_field<T>([&](const auto& f) { codec::decode_field(j, f, x); });
}

/// The JSON form of a message: its fields and its `"type"`.
template <class T>
json message_json(const T& x) {
  json j = x;
  j["type"] = T::type;
  return j;
}

} // namespace roscell
