#pragma once

#include "tools/roscell/cells/cell_document.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <string>

namespace roscell::cli {

/// What the cell has now: its members, the builds that are its own, and the
/// requests of its tasks that have not ended.
cell_document document_of_cell(const node_client& node);

/// Writes it to a file, or to standard output for "-", and beside a file, in a
/// folder named after it, the builds; those that are there already are not
/// fetched again. Nothing is left of a file that cannot be written whole.
void export_cell(const node_client& node, const std::string& file,
                 bool with_skills);

} // namespace roscell::cli
