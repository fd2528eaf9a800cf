#pragma once

#include "messages/codec/described.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/node.hpp"

#include <array>
#include <string>
#include <vector>

namespace roscell {

/// Has a node look at its host, as `roscell doctor` does there.
struct examination_query {
  static constexpr const char* type = "examination_query";
  std::string node; ///< Which one; empty: the one that is asked.

  static constexpr auto fields() {
    return field_list{optional("node", &examination_query::node)};
  }
};

/// How a check ended, the better ones first.
enum class judgement { ok, skipped, warning, broken };

constexpr auto enum_words(judgement) {
  return std::array<std::string_view, 4>{"ok", "skipped", "warning", "broken"};
}

/// What one look at a host or a node has found.
struct finding {
  finding() = default;

  finding(judgement how_is_it, std::string what, std::string why = {},
          std::string fix = {})
      : how{how_is_it}, seen{std::move(what)}, matters{std::move(why)},
        remedy{std::move(fix)} {}

  judgement how = judgement::ok;
  std::string seen;    ///< One sentence without its full stop.
  std::string matters; ///< What comes of it; empty if nothing is wrong.
  std::string remedy;  ///< A command that can be pasted; may be empty.
  std::string check;   ///< Name of the check, filled in by who runs it.
  std::string area;    ///< Likewise: "network", "host", "node" or "cell".
  std::string node;    ///< Whose host it is; empty: this one's.

  static constexpr auto fields() {
    return field_list{required("check", &finding::check),
                      required("area", &finding::area),
                      optional("node", &finding::node),
                      required("verdict", &finding::how),
                      required("seen", &finding::seen),
                      optional("matters", &finding::matters),
                      optional("remedy", &finding::remedy)};
  }
};

using findings = std::vector<finding>;

/// Reply to `examination_query`.
struct examination {
  static constexpr const char* type = "examination";
  std::string node;
  findings found;

  static constexpr auto fields() {
    return field_list{required("node", &examination::node),
                      required("findings", &examination::found)};
  }
};

/// Asks actors of a node what they know.
struct actor_query {
  static constexpr const char* type = "actor_query";
  std::string actor; ///< A name, which several may have, or an id.
  std::string node;  ///< Whose; empty: the one that is asked.

  static constexpr auto fields() {
    return field_list{required("actor", &actor_query::actor),
                      optional("node", &actor_query::node)};
  }
};

/// One actor, looked into.
struct inspected_actor_row {
  actor_row counters;
  std::string state; ///< JSON object; empty: it gave no answer in time.

  static constexpr auto fields() {
    return field_list{required("counters", &inspected_actor_row::counters),
                      raw_json("state", &inspected_actor_row::state)};
  }
};

/// Reply to `actor_query`, the oldest actor first.
struct actor_inspection {
  static constexpr const char* type = "actor_inspection";
  std::vector<inspected_actor_row> actors;

  static constexpr auto fields() {
    return field_list{required("actors", &actor_inspection::actors)};
  }
};

} // namespace roscell
