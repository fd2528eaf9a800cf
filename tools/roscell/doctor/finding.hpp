#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/insight/examination.hpp"

namespace roscell::cli {

/// "ok", "skipped", "warning", "broken".
const char* to_word(judgement how);

/// Whether one of them is broken.
bool is_broken(const findings& all);

/// [{"check", "area", "node", "verdict", "seen", "matters", "remedy"}, ...];
/// what is empty is left out.
json to_json_list(const findings& all);

} // namespace roscell::cli
