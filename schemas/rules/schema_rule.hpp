#pragma once

#include "messages/codec/json_codec.hpp"

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roscell {

/// A regular expression as our schemas use them: `^`, then characters, escapes
/// and classes, each with an optional `*`, `+` or `{m,n}`, then `$`. Matching
/// neither recurses nor backtracks; std::regex does both, so that a long string
/// from outside can drive it out of its stack.
class text_pattern {
public:
  /// Throws std::invalid_argument for an expression outside that subset.
  explicit text_pattern(std::string_view expression);

  bool matches(std::string_view utf8) const;

private:
  /// A class of characters and how often one of it may stand here.
  struct part {
    std::vector<std::pair<char32_t, char32_t>> ranges;
    bool negated = false;
    uint32_t at_least = 1;
    uint32_t at_most = 1;

    bool takes(char32_t c) const;
  };

  class parser;

  std::vector<part> parts_;
};

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
/// holds what our schemas use; schemas/rules/schema_rule.hpp refuses anything
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

/// Reads JSON Schema documents into rules, which it owns and which stay where
/// they are. Not thread-safe.
class schema_reader {
public:
  /// The rule of a schema of the project; read when it is first asked for,
  /// along with the documents that it refers to. Throws std::logic_error for an
  /// unknown name, or for a schema with a keyword that the rules cannot
  /// express: both are defects of this program.
  const schema_rule& rule(const std::string& name);

  /// As `rule`, for any other schema; tests use it.
  const schema_rule& read(const std::string& name, const json& document);

private:
  /// A rule for a subschema of document `name`.
  const schema_rule* part(const std::string& name, const json& schema);

  void fill(schema_rule& rule, const std::string& name, const json& schema);
  void fill_members(schema_rule& rule, const std::string& name,
                    const json& schema);

  std::deque<schema_rule> parts_;
  std::map<std::string, schema_rule> slots_; ///< By "document#pointer".
};

/// Says of a member that a rule does not describe which one was probably meant,
/// by its spelling or by its name in other systems, or else which there are:
/// `there is no member "label" here; did you mean "labels"?`
std::string unknown_member_text(const schema_rule& rule,
                                const std::string& name);

} // namespace roscell
