#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// The layers of container images: each is known by what it holds (diff id) and
/// with all that are below it by its chain id. All ids are "sha256:...".
namespace roscell {

/// From the bottom.
std::vector<std::string> chain_ids(const std::vector<std::string>& diff_ids);

/// How many layers of an image, from the bottom, an engine has that knows these
/// chains.
size_t layers_there(const std::vector<std::string>& diff_ids,
                    const std::vector<std::string>& chains);

} // namespace roscell
