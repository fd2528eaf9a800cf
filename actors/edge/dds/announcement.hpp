#pragma once

#include "actors/edge/dds/rtps/discovery_probe.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// What a participant says of itself before anybody has a session with it. It
/// rides in the USER_DATA of the DDS participant, so it costs no topic.
///
/// The roles, and what each says:
///
/// - `coordinator`: everything. Inside its cell it may leave out `discovery`
///   and `server`, which whoever hears it there knows.
/// - `member`: who it is, inside its cell only.
/// - `independent`: a primary without a cell; who it is and its `epoch`.
/// - `orphaned`: the same, and the `cell` that it lost.
/// - `surveyor`: looks around for a moment; nothing but the role.
///
/// Wire form: `roscell=1.0;role=coordinator;node=alpha;...`, the `key=value;`
/// form that ROS 2 uses in the same place. In values, `%`, `;`, `=`, control
/// bytes and bytes above 0x7e are written as `%` and two hex digits.
struct announcement {
  std::string protocol_version = "1.0"; ///< "MAJOR.MINOR" of the sessions.
  std::string role;                     ///< One of those above.
  std::string node;                     ///< Name of the node.
  std::string cell;                     ///< Name of the cell, or the last one.
  std::string session;                  ///< "ip:port" where it takes HTTP.
  std::string uuid;                     ///< Of the node.
  std::int64_t incarnation = 0;         ///< Raised at every start.
  std::int64_t epoch = 0;               ///< Registration epoch of the node.
  std::string discovery;   ///< "ip:port" of the cell's discovery server.
  std::int64_t server = 0; ///< Id n of the cell's discovery server.
  std::string cell_uuid;   ///< Of the cell; absent in older versions.
};

bool operator==(const announcement& x, const announcement& y);
bool operator!=(const announcement& x, const announcement& y);

/// The wire form of `x`. It never fails; what does not fit into
/// `limits::discovery::announcement_bytes` is refused where it is sent.
std::string encode(const announcement& x);

/// Reads a wire form. Unknown keys are ignored, absent ones stay empty, so
/// that another protocol version can still be refused by its name. Gives none
/// for the USER_DATA of unauthenticated peers: whatever does not start with a
/// version, is too long, repeats a key or is damaged. Never throws but for lack
/// of memory.
std::optional<announcement> decode(std::string_view bytes);

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
