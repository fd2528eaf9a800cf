#pragma once

#include "messages/node.hpp"

#include <string>
#include <vector>

namespace roscell {

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
