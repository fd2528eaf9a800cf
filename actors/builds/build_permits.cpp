#include "actors/builds/build_permits.hpp"

#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/crypto.hpp"

#include <utility>

namespace roscell {

void build_permits::use_key(std::string key) {
  const std::lock_guard guard{mutex_};
  key_ = std::move(key);
}

bool build_permits::allows(const std::string& path, std::string_view token,
                           const std::string& from) const {
  if (token.empty() || path.compare(0, builds_path.size(), builds_path) != 0)
    return false;
  const auto begin = builds_path.size();
  const auto hash = path.substr(begin, path.find('/', begin) - begin);
  const std::lock_guard guard{mutex_};
  return !key_.empty() && equal_in_constant_time(token, sign(key_, hash, from));
}

std::string build_permits::sign(std::string_view key, const std::string& hash,
                                const std::string& reader) {
  return to_hex(hmac_sha256(key, "build " + hash + " for " + reader));
}

} // namespace roscell
