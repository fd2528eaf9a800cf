#pragma once

#include "actors/builds/build_fetcher.hpp"
#include "actors/edge/io/io_core.hpp"

#include <memory>

namespace roscell {

class site_identity;

/// Asks sources of builds by HTTP; answers come as `source_answered`.
/// @param identity by which it asks; null: in clear.
/// @param from the node's own address, for which its permits are.
std::function<void(const build_fetcher_actor&, const source_question&)>
source_asker(std::shared_ptr<io_core> io, std::string from,
             std::shared_ptr<site_identity> identity);

} // namespace roscell
