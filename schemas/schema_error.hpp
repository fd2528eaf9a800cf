#pragma once

#include "messages/failure.hpp"

#include <string>
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

} // namespace roscell
