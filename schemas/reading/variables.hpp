#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <variant>

namespace roscell {

/// What filling in a document may cost.
struct variable_limits {
  size_t max_variables = 64;
  size_t max_name_bytes = 63;
  size_t max_added_bytes = 1024 * 1024; ///< By all values together.
};

/// What a person gives for the variables of a document.
struct given_values {
  json typed = json::object(); ///< By name, from a file of values.
  /// By name, from a command line: read as the variable's default is. These
  /// count more.
  std::map<std::string, std::string> words;

  bool empty() const {
    return typed.empty() && words.empty();
  }
};

/// Fills in what a document leaves open, so that one file serves many tasks.
/// Its member `variables` names them, each with its default, or null where a
/// value has to be given; it is not in the result. `${name}` in a text of the
/// rest stands for the value of `name`: a text that is nothing else becomes the
/// value, a number stays a number; inside of a text it is written out. `$${`
/// stands for `${`. `${node}` and `${copy}` stay where no variable has that
/// name: a coordinator fills them in. A document without `variables` stays as
/// it is. Values are not filled in themselves.
///
/// Errors: schema_violation (an unknown or bad name, no value or one of another
/// kind, a list within a text, too much), with its place in the document.
std::variant<json, failure> fill_variables(json document,
                                           const given_values& given,
                                           const variable_limits& limits = {});

} // namespace roscell
