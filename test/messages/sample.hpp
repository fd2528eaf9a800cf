#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/task_update.hpp"

#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

/// Fills described structs with values that differ from their defaults and
/// from each other, and that the schemas allow.
namespace roscell::test {

/// How much of a struct is filled.
enum class extent {
  full,  ///< Every field.
  least, ///< The fields that always appear in JSON; lists are empty.
};

/// A text that the schemas allow for a field of that name in a struct whose
/// message type, if it has one, is `type`. `number` makes it unique.
std::string sample_text(std::string_view type, std::string_view field,
                        int number);

class sampler {
public:
  explicit sampler(extent how_much) : extent_(how_much) {
    // nop
  }

  template <class T>
  T make() {
    T result;
    fill_struct(result);
    return result;
  }

private:
  template <class T, class = void>
  struct type_of {
    static constexpr std::string_view value = "";
  };

  template <class T>
  struct type_of<T, std::void_t<decltype(T::type)>> {
    static constexpr std::string_view value = T::type;
  };

  /// The message's type, or the name of a part in which a field holds what it
  /// holds nowhere else.
  template <class T>
  static constexpr std::string_view name_of() {
    if constexpr (std::is_same_v<T, task_revision>)
      return "task_revision";
    else if constexpr (std::is_same_v<T, task_set_row>)
      return "task_set_row";
    else
      return type_of<T>::value;
  }

  template <class T>
  void fill_struct(T& x) {
    for_each_field<T>([&](const auto& field) {
      using field_type = std::decay_t<decltype(field)>;
      constexpr bool needed = field_type::kind == presence::required
                              || field_type::kind == presence::nullable;
      context_ = {name_of<T>(), field.name};
      // An envelope without a body is none, although JSON could leave it out.
      if (needed || extent_ == extent::full || context_.second == "body")
        fill(x.*(field.member));
    });
  }

  void fill(bool& x) {
    x = !x;
  }

  void fill(double& x) {
    // Three leases at least.
    x = (context_.second == "after_s" ? 24.25 : 0.25) + ++number_;
  }

  template <class T>
  std::enable_if_t<std::is_integral_v<T>> fill(T& x) {
    ++number_;
    const bool small = context_.second == "priority"
                       || context_.second == "nice"
                       || context_.second == "copies";
    x = static_cast<T>(small ? 7 : number_);
  }

  template <class T>
  std::enable_if_t<std::is_enum_v<T>> fill(T& x) {
    const auto words = enum_words(T{}).size();
    x = static_cast<T>((static_cast<size_t>(x) + 1) % words);
  }

  void fill(std::string& x) {
    x = sample_text(context_.first, context_.second, ++number_);
  }

  void fill(std::map<std::string, std::string>& x) {
    if (extent_ != extent::full)
      return;
    // A secret has a name, and its variable is none of "env".
    if (context_.second == "secret_env")
      x = {{"secret_1", "value_1"}};
    else
      x = {{"key_1", "value 1"}, {"key_2", ""}};
  }

  /// One verdict has one specification; both forms of streams are tried; a
  /// histogram has all its buckets.
  static size_t length_of(std::string_view field) {
    return field == "output" ? 2 : field == "latency_counts" ? 11 : 1;
  }

  template <class T>
  void fill(std::vector<T>& x) {
    const auto context = context_;
    const size_t n = length_of(context.second);
    for (size_t i = 0; extent_ == extent::full && i < n; ++i) {
      context_ = context;
      fill(x.emplace_back());
    }
  }

  template <class T>
  std::enable_if_t<is_described<T>::value> fill(T& x) {
    fill_struct(x);
  }

  extent extent_;
  int number_ = 0;
  std::pair<std::string_view, std::string_view> context_;
};

} // namespace roscell::test
