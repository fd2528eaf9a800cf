#pragma once

#include <caf/error.hpp>
#include <caf/mailbox_element.hpp>
#include <caf/make_message.hpp>
#include <caf/sec.hpp>

#include <cstddef>
#include <type_traits>
#include <utility>

/// One list of fields per struct, from which equality, CAF's `inspect` and the
/// JSON codec (messages/codec/json_codec.hpp) are all derived, so that a field
/// cannot be forgotten in one of them. A described struct says
///
///     static constexpr auto fields() {
///       return field_list{required("task", &task_query::task),
///                         optional("limit", &task_query::limit)};
///     }
namespace roscell {

/// How a member appears in JSON.
enum class presence {
  required,    ///< Always there.
  optional,    ///< Left out when equal to the struct's default.
  nullable,    ///< Always there; `null` when it is negative (an index).
  one_or_many, ///< An array, or its only element; left out when empty.
  raw_json,    ///< A string member that holds JSON text; left out when empty.
};

/// One member of a described struct.
template <presence Presence, class Struct, class Member>
struct field {
  static constexpr presence kind = Presence;
  const char* name;
  Member Struct::*member;
};

template <class S, class M>
constexpr auto required(const char* name, M S::*member) {
  return field<presence::required, S, M>{name, member};
}

template <class S, class M>
constexpr auto optional(const char* name, M S::*member) {
  return field<presence::optional, S, M>{name, member};
}

template <class S, class M>
constexpr auto nullable(const char* name, M S::*member) {
  return field<presence::nullable, S, M>{name, member};
}

template <class S, class M>
constexpr auto one_or_many(const char* name, M S::*member) {
  return field<presence::one_or_many, S, M>{name, member};
}

template <class S, class M>
constexpr auto raw_json(const char* name, M S::*member) {
  return field<presence::raw_json, S, M>{name, member};
}

/// The fields of a struct in their order: an aggregate, which has nothing to
/// instantiate in the many sources that only see a struct, as a tuple has.
template <class... Fields>
struct field_list;

template <>
struct field_list<> {
  static constexpr std::size_t size = 0;

  template <class Visitor>
  constexpr void visit(Visitor&) const {
    // nop
  }
};

template <class Field, class... Fields>
struct field_list<Field, Fields...> {
  static constexpr std::size_t size = 1 + sizeof...(Fields);

  Field first;
  field_list<Fields...> rest;

  /// Calls `visitor(field)` for each.
  template <class Visitor>
  constexpr void visit(Visitor& visitor) const {
    visitor(first);
    rest.visit(visitor);
  }
};

template <class... Fields>
field_list(Fields...) -> field_list<Fields...>;

template <class T, class = void>
struct is_described : std::false_type {};

template <class T>
struct is_described<T, std::void_t<decltype(T::fields())>> : std::true_type {};

template <class T>
using if_described = std::enable_if_t<is_described<std::decay_t<T>>::value>;

/// Calls `visit(field)` for each field of `T`, in order.
template <class T, class Visitor>
void for_each_field(Visitor&& visit) {
  T::fields().visit(visit);
}

/// CAF's view of a described struct. Messages never leave the process as CAF's
/// bytes (between machines they are JSON), so there is nothing to load or save,
/// and a message that CAF prints shows no more than that it is one.
template <class Inspector, class T, class = if_described<T>>
typename Inspector::result_type inspect(Inspector& f, T&) {
  if constexpr (std::is_void_v<typename Inspector::result_type>)
    f.consume("message");
  else
    return caf::sec::unknown_type;
}

/// Whether all fields are equal. Defined in messages/codec/instantiate.hpp.
template <class T, class = if_described<T>>
bool operator==(const T& x, const T& y);

template <class T, class = if_described<T>>
bool operator!=(const T& x, const T& y) {
  return !(x == y);
}

} // namespace roscell

namespace caf {

/// A struct lies in a mailbox as the message that it also is in a promise or a
/// delayed send, so that a second class of elements need not be compiled for
/// each struct. CAF's `send` and `request` find this by the struct's fields.
template <class T, class = roscell::if_described<T>>
mailbox_element_ptr
make_mailbox_element(strong_actor_ptr sender, message_id id,
                     mailbox_element::forwarding_stack stages, T&& x) {
  return make_mailbox_element(std::move(sender), id, std::move(stages),
                              make_message(std::forward<T>(x)));
}

} // namespace caf
