#pragma once

#include "messages/formation.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>
#include <vector>

/// The replies about nodes that move, as text for people.
namespace roscell::cli {

std::string formation_view(const cell_formed& formed, const view_style& style);

/// What helps the names that failed, each advice once.
std::vector<std::string> hints_of(const cell_formed& formed);

std::string transferred_view(const node_transferred& moved,
                             const view_style& style);
std::string released_view(const node_released& moved, const view_style& style);
std::string transfers_view(const transfer_description& transfers,
                           const view_style& style);

} // namespace roscell::cli
