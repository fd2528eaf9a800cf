#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/node/node_data.hpp"
#include "actors/node/node_edges.hpp"
#include "roscell/node_config.hpp"

#include <caf/expected.hpp>

#include <cstdint>

namespace roscell {

/// Looks at the coordinators that are there, and gives the id of the discovery
/// server of a new one. What is announced is a hint until it is proven: whoever
/// claims the cell's name, or this node's UUID, is asked for a proof of the
/// site token, all of them at once, and one that has none is told of as
/// `claim_ignored`. Where nobody had one, the site is looked at once more, for
/// an owner who is heard later. A coordinator that has another address than at
/// its last start asks at that one first, heard or not: its data directory may
/// be a copy. Blocks for `limits::discovery::survey`; if there are any, also
/// for `second_survey` and twice `limits::token::claim_proof` at most; at
/// another address for `claim_proof` more at most.
///
/// Errors: conflict (somebody who proves it coordinates that cell), internal
/// (its address cannot be written down).
caf::expected<uint8_t> claim_cell(const node_config& config,
                                  const node_data& data, node_edges& edges,
                                  const actor_context& context);

} // namespace roscell
