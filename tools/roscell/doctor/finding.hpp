#pragma once

#include "messages/codec/json_codec.hpp"

#include <string>
#include <utility>
#include <vector>

namespace roscell::cli {

/// How a check ended, the better ones first.
enum class judgement { ok, skipped, warning, broken };

/// "ok", "skipped", "warning", "broken".
const char* to_word(judgement how);

/// What one look at a host or a node has found.
struct finding {
  finding() = default;

  finding(judgement how, std::string seen, std::string matters = {},
          std::string remedy = {})
      : how{how}, seen{std::move(seen)}, matters{std::move(matters)},
        remedy{std::move(remedy)} {}

  judgement how = judgement::ok;
  std::string seen;    ///< One sentence without its full stop.
  std::string matters; ///< What comes of it; empty if nothing is wrong.
  std::string remedy;  ///< A command that can be pasted; may be empty.
  std::string check;   ///< Name of the check, filled in by who runs it.
  std::string area;    ///< Likewise: "network", "host" or "node".
};

using findings = std::vector<finding>;

/// Whether one of them is broken.
bool is_broken(const findings& all);

/// [{"check", "area", "verdict", "seen", "matters", "remedy"}, ...]; what is
/// empty is left out.
json to_json_list(const findings& all);

} // namespace roscell::cli
