#pragma once

#include "messages/codec/json_codec.hpp"

#include <array>
#include <string_view>

/// The JSON that the command line prints (docs/output/): one shape for one
/// thing, whichever command prints it and wherever in a document it stands.
namespace roscell::cli {

/// What a node tells of a thing, as programs get it: with its `name`; times as
/// ISO 8601 in UTC, `since` instead of `since_unix_ms`, null where they are not
/// known; ends of a stream always as a list. The same for what is inside it.
json shaped(const json& reported);

/// Members of a reply; an empty name is none.
using reply_parts = std::array<std::string_view, 2>;

/// The things of a reply as a list, each `shaped`: those in these parts of it,
/// or, where none is named, the reply itself.
json shaped_list(const json& reply, const reply_parts& parts);

} // namespace roscell::cli
