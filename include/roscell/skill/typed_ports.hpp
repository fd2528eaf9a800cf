#pragma once

#include "roscell/skill/environment.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace roscell::engine {

/// The numbers of the streams of one data type, in their order. A skill for
/// several sources takes the k-th stream of each type to belong together.
std::vector<std::size_t> ports_of_type(const std::vector<stream>& streams,
                                       const std::string& data_type);

/// The output of a type for source number `k` of `sources`: the k-th one, or
/// the only one, which all sources then share. `none` if there is no output
/// of that type. Throws start_error if there are some, but neither one nor as
/// many as sources.
class typed_outputs {
public:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  typed_outputs(const std::vector<stream>& outputs,
                const std::string& data_type, std::size_t sources);

  std::size_t of_source(std::size_t k) const;

private:
  const std::vector<std::size_t> ports_;
};

} // namespace roscell::engine
