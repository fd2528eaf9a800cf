#pragma once

#include "messages/codec/json_codec.hpp"

#include <string>
#include <string_view>

namespace roscell {

/// What a request is, as far as it has to be known before it is checked.
struct request_outline {
  std::string type;    ///< Empty: it says none, and is refused for that.
  std::string subject; ///< What it is about, for people; may be empty.
};

request_outline outline_of(const json& document);

/// The same of a request as it has come.
request_outline outline_of(const std::string& text);

/// Whether a request of that type changes nothing.
bool is_query(std::string_view type);

/// Whether it is worth to be kept that somebody has asked. Queries are many,
/// and would drive out all others; so would what is given to a command, whose
/// beginning is kept.
bool is_remarkable(std::string_view type);

} // namespace roscell
