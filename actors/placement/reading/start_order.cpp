#include "actors/placement/reading/start_order.hpp"

#include "actors/placement/reading/stream_names.hpp"
#include "messages/stream_protocols.hpp"

#include <algorithm>

namespace roscell {

namespace {

using order = std::vector<std::vector<std::size_t>>;

bool reads_from(const instance_spec& reader, const instance_spec& writer) {
  for (const auto& in : reader.input)
    for (const auto& out : writer.output)
      if (in.protocol == protocols::file && out.protocol == protocols::file
          && overlap(in.endpoint, out.endpoint))
        return true;
  return false;
}

/// Whether `from` waits for `wanted`, directly or by others.
bool waits_for(const order& known, std::size_t from, std::size_t wanted) {
  std::vector<std::size_t> open{from};
  std::vector<bool> seen(known.size());
  while (!open.empty()) {
    const auto i = open.back();
    open.pop_back();
    if (i == wanted)
      return true;
    if (!seen[i])
      open.insert(open.end(), known[i].begin(), known[i].end());
    seen[i] = true;
  }
  return false;
}

} // namespace

order start_order(const std::vector<instance_spec>& specs) {
  order result(specs.size());
  // The last of the list first, so that of a circle the first ones are free.
  for (auto reader = specs.size(); reader-- > 0;)
    for (std::size_t writer = 0; writer < specs.size(); ++writer)
      if (reader != writer && reads_from(specs[reader], specs[writer])
          && !waits_for(result, writer, reader))
        result[reader].push_back(writer);
  return result;
}

} // namespace roscell
