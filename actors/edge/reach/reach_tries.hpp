#pragma once

#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/reach/reach_port.hpp"
#include "messages/insight/reach.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace roscell {

/// Who tries to reach others.
struct reach_setup {
  std::shared_ptr<io_core> core;
  std::string address; ///< Local, dotted.
  digest key{};
  std::shared_ptr<site_identity> identity{}; ///< Null: it asks in clear.
};

/// Tries every way to every goal, all at once. `done` is called once, on the io
/// thread, within `limits::membership::probed`, with a row for each goal and
/// way, in their order; a goal without a discovery server has none for that,
/// and one with two ports for data has two. From any thread.
void try_to_reach(const reach_setup& setup,
                  const std::vector<reach_goal>& goals,
                  std::function<void(std::vector<reach_row>)> done);

} // namespace roscell
