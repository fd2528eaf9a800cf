#pragma once

#include "messages/codec/json_codec.hpp"

#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

/// JSON Schemas that are made of the fields of a struct. A type says what kind
/// of value its field holds, and of an enumeration which words; how long a text
/// and how large a number may be, its name says: fields of one name mean the
/// same in all messages that only nodes send to each other.
namespace roscell {

/// The definition of a struct in schemas/common.schema.json; null for one that
/// has none, whose schema is made of its fields.
template <class T>
inline constexpr const char* shared_definition = nullptr;

namespace field_schemas {

/// What text or a number in a field of that name may be. Throws, as everything
/// below does, std::logic_error for a name without a rule: a defect of ours.
json named(std::string_view field);

/// A list of `items` in a field of that name, as long as that may be.
json list(std::string_view field, const json& items);

/// One of `items`, or a list where a field of that name may be one.
json one_or_list(std::string_view field, const json& items);

/// A reference to a definition of schemas/common.schema.json.
json definition(std::string_view name);

/// The schema of an object, whose members are then added.
json empty_object();
void add_member(json& object, const char* name, json rule, bool required);

template <class T>
struct is_list : std::false_type {};

template <class E>
struct is_list<std::vector<E>> : std::true_type {};

template <class T>
json of_fields();

template <class T>
json of_value(std::string_view field) {
  if constexpr (is_list<T>::value)
    return list(field, of_value<typename T::value_type>(field));
  else if constexpr (std::is_same_v<T, bool>)
    return {{"type", "boolean"}};
  else if constexpr (std::is_enum_v<T>)
    return {{"type", "string"}, {"enum", enum_words(T{})}};
  else if constexpr (!is_described<T>::value)
    return named(field);
  else if constexpr (shared_definition<T> != nullptr)
    return definition(shared_definition<T>);
  else
    return of_fields<T>();
}

template <class Field, class Struct, class Member>
json of_field(std::string_view field, Member Struct::*) {
  static_assert(Field::kind != presence::nullable,
                "no rule says how large an index may be");
  if constexpr (Field::kind == presence::one_or_many)
    return one_or_list(field, of_value<typename Member::value_type>(field));
  else
    return of_value<Member>(field);
}

/// The schema of an object with the fields of `T`. A field that holds a whole
/// message is required: it is what its envelope is for.
template <class T>
json of_fields() {
  auto result = empty_object();
  for_each_field<T>([&result](const auto& x) {
    using field = std::decay_t<decltype(x)>;
    constexpr bool required =
        field::kind == presence::required || field::kind == presence::raw_json;
    add_member(result, x.name, of_field<field>(x.name, x.member), required);
  });
  return result;
}

} // namespace field_schemas

} // namespace roscell
