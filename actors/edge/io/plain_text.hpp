#pragma once

#include <string_view>

/// What unauthenticated peers may call themselves: it ends up in replies and
/// logs.
namespace roscell {

/// Whether the byte is an ASCII control character.
bool is_control(char c);

/// Whether the text can name a node or a cell: as `name` in
/// schemas/common.schema.json.
bool is_name(std::string_view text);

/// Whether the text can be a node's UUID: as `uuid` there.
bool is_uuid(std::string_view text);

} // namespace roscell
