#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <string>

namespace roscell {

/// The nodes that a coordinator has met, or made identities for: what they are
/// called belongs to them, and somebody new gets it by an invitation for that
/// name alone. From any thread.
class known_nodes {
public:
  static constexpr size_t most = 8192;

  enum class claim {
    free,
    taken,   ///< Its name or UUID is another one's.
    by_name, ///< It is one that is known, if whoever invites says so.
  };

  void add(const std::string& name, const std::string& uuid);

  claim judge(const std::string& name, const std::string& uuid) const;

private:
  mutable std::mutex mutex_;                    // Guards what follows.
  std::map<std::string, std::string> names_;    ///< By UUID.
  std::map<std::string, size_t> uuids_by_name_; ///< How many have it.
};

} // namespace roscell
