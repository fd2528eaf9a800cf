#pragma once

#include "messages/codec/json_codec.hpp"
#include "schemas/rules/schema_rule.hpp"

#include <deque>
#include <map>
#include <string>

namespace roscell {

/// Reads JSON Schema documents into rules, which it owns and which stay where
/// they are. Not thread-safe.
class schema_reader {
public:
  /// The rule of an embedded schema; read when it is first asked for, along
  /// with the documents that it refers to. Throws std::logic_error for an
  /// unknown name, or for a schema with a keyword that the rules cannot
  /// express: both are defects of this program.
  const schema_rule& rule(const std::string& name);

  /// As `rule`, for a schema that is not embedded; tests use it.
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

} // namespace roscell
