#pragma once

#include "actors/placement/reading/short_forms.hpp"
#include "messages/inside/placement.hpp"
#include "messages/instance.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// How the steps of a task hang together.
struct wiring {
  std::vector<schema_error> errors;
  std::vector<std::string> warnings; ///< Each names its places.
  /// Per step: those with the same number, unless it is 0, read and write the
  /// same files, and so must share a node.
  std::vector<uint64_t> together;
};

/// Looks at what the steps read and write, and at what others of the cell
/// write. Errors: a topic that nobody writes and that is not `external`; types
/// that differ; a file that two steps write; a file between steps whose labels
/// keep them apart. Warnings: a topic that two write, but for transforms, which
/// many write; a folder that two write; what another task writes as well; an
/// external topic that is written by the task itself, or by nobody in `topics`
/// yet, if these are known.
wiring find_wiring(const std::string& task,
                   const std::vector<written_step>& steps,
                   const std::vector<deployed_end>& cell,
                   const std::optional<std::vector<io_endpoint>>& topics = {});

/// For each of these instances the ones that must run before it starts: those
/// that write a file which it reads, because a file that is not there is an
/// error. Nobody waits for itself in the end: where instances read each other's
/// files, those that come first in the list do not wait.
std::vector<std::vector<std::size_t>>
start_order(const std::vector<instance_spec>& specs);

} // namespace roscell
