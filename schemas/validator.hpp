#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// One place where a document breaks its schema.
struct schema_error {
  std::string pointer;  ///< JSON pointer (RFC 6901) to it, escaped.
  std::string expected; ///< "expected ..., got ...".

  friend bool operator==(const schema_error& x, const schema_error& y) {
    return x.pointer == y.pointer && x.expected == y.expected;
  }
};

/// All errors as one refusal: schema_violation, `where` the first place, and
/// in `details` {"errors":[{"where","expected"}, ...]}. Of more than 50 errors
/// the first 50 are listed, and "more" counts the others.
/// `errors` must not be empty.
failure to_failure(const std::vector<schema_error>& errors);

struct schema_rule;

/// What becomes of members that a schema does not describe, other than those of
/// an object of which it describes none, as a model's parameters.
enum class unknown_members {
  taken,   ///< A newer peer may say more.
  refused, ///< A user is no newer peer: one that is misspelt would be dropped.
};

/// Checks documents against the schemas of the project. A schema is read when
/// it is first needed and then kept: a node that never sees a message type does
/// not pay for it. All members may be called by several threads at once.
class validator {
public:
  /// More errors than this are not collected from one document.
  static constexpr size_t max_errors = 1000;

  validator();
  ~validator();
  validator(const validator&) = delete;
  validator& operator=(const validator&) = delete;

  /// The validator that the functions in schemas/message_catalogue.hpp share.
  /// Schemas are constants, so one per process is enough.
  static const validator& shared();

  /// Every error of `document` against the schema of that name, in the order
  /// of the schema; none if it is valid. The name is that of a schema of
  /// the project, anything else throws std::logic_error.
  std::vector<schema_error>
  validate(std::string_view schema, const json& document,
           unknown_members others = unknown_members::taken) const;

private:
  struct state;

  std::unique_ptr<state> state_;
};

/// Checks a document against one rule.
std::vector<schema_error>
validate(const schema_rule& rule, const json& document,
         unknown_members others = unknown_members::taken);

/// What a schema cannot express: ids that must differ from each other, paths
/// that must stay below a folder, parts that are needed because of other parts.
/// `type` names the schema of the document, which may still break it: parts of
/// the wrong shape are passed over, so that both kinds of errors can be
/// reported together.
std::vector<schema_error> semantic_errors(std::string_view type,
                                          const json& document);

} // namespace roscell
