#include "client/stale_answers.hpp"

#include <algorithm>

namespace roscell {

namespace {

bool fits(std::string_view what, std::string_view name) {
  if (name.back() != '*')
    return what == name;
  name.remove_suffix(1);
  return what.substr(0, name.size()) == name;
}

} // namespace

const stale_list& stale_answers() {
  static const stale_list result{
      {"node_joined", {"cell", "cells", "skills"}},
      {"node_left", {"cell", "cells", "skills"}},
      {"node_lost", {"cell", "cells", "skills"}},
      {"node_*", {"cell"}},
      {"cell_joined", {"cell", "cells", "skills", "node"}},
      {"cell_left", {"cell", "cells", "node"}},
      {"cell_name_conflict", {"cells"}},
      {"cell*", {"cell", "cells"}},
      {"coordinator_lost", {"cell", "node"}},
      {"transfer_*", {"cell", "cells"}},
      {"switch_*", {"cell"}},
      {"peer_*", {"cells"}},
      {"skill_refused", {"skills"}},
      // Steps that begin, end or go elsewhere.
      {"task_*", {"task"}},
      {"step_*", {"task"}},
      {"allocation_chosen", {"task"}},
      {"instance_changed", {"task"}},
      {"instance_moved", {"task"}},
      {"instance_restarted", {"task"}},
      {"instance_awaited", {"task"}},
      {"instance_out_of_reach", {"task"}},
      {"instance_interrupted", {"task"}},
      {"instance_preempted", {"task"}},
      {"skill_instance_died", {"task"}},
  };
  return result;
}

const std::vector<std::string>& stale_after(std::string_view what) {
  static const std::vector<std::string> none;
  const auto& all = stale_answers();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& x) {
    return fits(what, x.first);
  });
  return found == all.end() ? none : found->second;
}

} // namespace roscell
