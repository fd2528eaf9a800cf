#pragma once

#include <mutex>
#include <string>
#include <string_view>

namespace roscell {

/// By which a node gives a build to another one: the coordinator shares a key
/// with each node of the cell, and signs with it who may read which build from
/// that node. So a node serves nobody else, and is told nothing beforehand. May
/// be used by any thread.
class build_permits {
public:
  /// What the coordinator and this node share; empty: nobody is served.
  void use_key(std::string key);

  /// Whether the token lets a node at `from` read `path`.
  bool allows(const std::string& path, std::string_view token,
              const std::string& from) const;

  /// The permit for a node at `reader` to read a build from the one whose key
  /// it is.
  static std::string sign(std::string_view key, const std::string& hash,
                          const std::string& reader);

private:
  mutable std::mutex mutex_;
  std::string key_;
};

} // namespace roscell
