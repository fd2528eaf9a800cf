#pragma once

#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"

#include <chrono>
#include <cstddef>
#include <map>
#include <vector>

namespace roscell {

/// INTERNAL to this folder: what the participants of the public domain
/// announce, one announcement each. Pure: it is told the time.
class presence_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  struct change {
    bool gone = false; ///< Else it is seen.
    announcement said;
  };

  struct outcome {
    bool newcomer = false; ///< It has not been heard of before.
    std::vector<change> changes;
  };

  /// What is to be told of an announcement.
  outcome remember(const guid_prefix& who, const announcement& said,
                   time_point now);

  /// The same, of one that has ended.
  std::vector<change> forget(const guid_prefix& who, time_point now);

  std::size_t size() const {
    return known_.size();
  }

private:
  struct entry {
    announcement said;
    time_point reported;
  };

  change succession(const announcement& former, time_point now);

  std::map<guid_prefix, entry> known_;
};

} // namespace roscell
