#include "actors/edge/engine/image_layers.hpp"

#include "actors/edge/io/crypto.hpp"

#include <algorithm>

namespace roscell {

std::vector<std::string> chain_ids(const std::vector<std::string>& diff_ids) {
  std::vector<std::string> result;
  result.reserve(diff_ids.size());
  for (const auto& x : diff_ids)
    result.push_back(
        result.empty() ? x : "sha256:" + sha256_hex(result.back() + ' ' + x));
  return result;
}

size_t layers_there(const std::vector<std::string>& diff_ids,
                    const std::vector<std::string>& chains) {
  const auto own = chain_ids(diff_ids);
  for (size_t n = own.size(); n > 0; --n)
    if (std::find(chains.begin(), chains.end(), own[n - 1]) != chains.end())
      return n;
  return 0;
}

} // namespace roscell
