#pragma once

#include "messages/codec/json_codec.hpp"
#include "tools/roscell/client/documents.hpp"

#include <string>
#include <vector>

/// A file that says what a cell shall have: its nodes, skills and tasks.
namespace roscell::cli {

/// A build that is the cell's.
struct wanted_skill {
  std::string operation;
  std::string build;  ///< Its hash.
  std::string source; ///< A folder or archive with it; empty: the cell has it.
};

struct cell_document {
  task_file file; ///< That it was read from.
  std::string cell;
  std::vector<std::string> nodes; ///< Besides the coordination node.
  std::vector<wanted_skill> skills;
  std::vector<task_file> tasks; ///< Each with its place in the file.
};

/// Reads such a file; paths of skills are as seen from here then. Throws
/// command_error if it cannot be read, and wrong_document for what is wrong
/// with it.
cell_document read_cell_document(const std::string& name,
                                 const file_values& values);

/// The same as a document, whose paths are seen from its own folder.
json document_of(const cell_document& cell);

} // namespace roscell::cli
