#pragma once

#include "schemas/rules/text_pattern.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// The kinds of JSON values, as bits of a set.
enum json_kind : uint8_t {
  kind_null = 1,
  kind_boolean = 2,
  kind_integer = 4,
  kind_number = 8, ///< Integers included.
  kind_string = 16,
  kind_array = 32,
  kind_object = 64,
};

/// One (sub)schema, read into the form that the validator walks. Of Draft 7 it
/// holds what our schemas use; schemas/rules/schema_reader.hpp refuses anything
/// else. Rules point to each other where schemas have `$ref`.
struct schema_rule {
  struct member {
    std::string name;
    const schema_rule* rule;
    bool required;
  };

  static constexpr uint32_t unlimited = std::numeric_limits<uint32_t>::max();

  uint8_t kinds = 0; ///< The kinds that are allowed; 0: any.

  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();

  /// Characters of a string, items of an array, members of an object.
  uint32_t min_size = 0;
  uint32_t max_size = unlimited;

  std::vector<std::string> words; ///< `enum` or `const`; empty: any string.
  std::optional<text_pattern> pattern;
  std::string pattern_text; ///< What the pattern asks for, in words.

  std::vector<member> members;                ///< `properties`, `required`.
  const schema_rule* member_names = nullptr;  ///< `propertyNames`.
  const schema_rule* other_members = nullptr; ///< `additionalProperties`.
  const schema_rule* items = nullptr;

  /// `oneOf`: the value follows the one of these whose kinds include its own.
  std::vector<const schema_rule*> choices;

  /// The described member of that name; null if there is none.
  const member* find_member(std::string_view name) const {
    for (const auto& x : members)
      if (x.name == name)
        return &x;
    return nullptr;
  }
};

/// What a rule asks for, as the object of "expected": `a string of at most 63
/// characters`, `an integer from 0 to 7`, `one of "cpu", "gpu"`.
std::string rule_text(const schema_rule& rule);

} // namespace roscell
