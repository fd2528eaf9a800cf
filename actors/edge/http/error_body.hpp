#pragma once

#include "messages/error_code.hpp"

#include <string>
#include <string_view>

namespace roscell {

/// The text of `{"type":"error","error":{"code","message","where","hint"}}`.
/// Bytes that are no UTF-8 are replaced.
std::string error_body(error_code code, std::string_view message,
                       std::string_view hint = {}, std::string_view where = {});

} // namespace roscell
