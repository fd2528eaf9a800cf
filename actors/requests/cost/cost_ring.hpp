#pragma once

#include "actors/core/metric_table.hpp"
#include "messages/insight/node_cost.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// What the node's process has cost so far.
struct cost_reading {
  double cpu_s = 0;
  double pss_bytes = 0; ///< At this moment.
  double written_bytes = 0;
  std::vector<peer_traffic> peers;
  peer_traffic builds; ///< With all nodes together.
};

/// Reads the process, and from the table what went over sessions; null: nothing
/// did.
cost_reading read_cost(const std::shared_ptr<metric_table>& table);

/// What a node has cost in the last minute, hour and day. Told the time and
/// what it has cost so far. Each of the three is the sum of some slices that
/// are complete and the one that is being filled, so it covers up to one slice
/// more than its name says, and less after the start.
///
/// Bounded: 16 slices of 64 bytes, for each peer 8 bytes in each of them and 48
/// for its name and counters, which is 2 KiB for a few peers and 12 KiB for the
/// most. Peers that come later count as "other".
class cost_ring {
public:
  using time_point = std::chrono::steady_clock::time_point;

  static constexpr size_t max_peers = 64;
  /// The shortest slice; whoever marks less often has longer ones.
  static constexpr std::chrono::minutes shortest_slice{1};

  /// The first reading is where it begins to count.
  void mark(time_point now, const cost_reading& reading);

  /// Minute, hour and day, until the last mark.
  std::vector<cost_window> windows() const;

private:
  /// A float tells a sum to seven digits, and there are many of these.
  struct traffic {
    float sent_bytes = 0;
    float received_bytes = 0;
  };

  struct slice {
    std::chrono::steady_clock::duration span{};
    double cpu_s = 0;
    double pss_byte_s = 0; ///< Its integral over the time.
    double written_bytes = 0;
    traffic builds;
    std::vector<traffic> peers; ///< By the peer's place; may be shorter.

    void add(const slice& other);
  };

  /// The slices of one length.
  struct track {
    const char* window;
    std::chrono::minutes length;
    size_t most; ///< Complete ones that are kept.
    slice filling = {};
    std::vector<slice> complete = {}; ///< The oldest first.

    void add(const slice& other);
    slice sum() const;
  };

  size_t place_of(const std::string& peer);
  std::vector<peer_traffic> by_place(const std::vector<peer_traffic>& reported);
  static traffic traffic_between(const peer_traffic& before,
                                 const peer_traffic& now);
  slice slice_until(time_point now, const cost_reading& reading) const;
  cost_window window_of(const track& x) const;

  std::array<track, 3> tracks_{{{"minute", shortest_slice, 1},
                                {"hour", std::chrono::minutes{10}, 6},
                                {"day", std::chrono::hours{4}, 6}}};
  std::optional<time_point> last_at_;
  cost_reading last_; ///< Its peers by place, the first of which is "other".
};

/// The ring of a node, and what it is told by. Any thread may mark and ask.
class cost_meter {
public:
  using reader = std::function<cost_reading()>;

  explicit cost_meter(reader read = [] { return cost_reading{}; });

  void mark(cost_ring::time_point now);

  /// What it has cost until now.
  std::vector<cost_window> windows(cost_ring::time_point now);

private:
  reader read_;
  /// Held while reading: two readings must not be told in the wrong order.
  std::mutex mutex_;
  cost_ring ring_;
};

} // namespace roscell
