#pragma once

#include "messages/instance.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// Whether a policy asks anything of a data stream.
bool has_bounds(const health_policy& policy);

struct health_verdict {
  instance_health health = instance_health::good;
  std::string reason; ///< One sentence without a full stop.
};

/// What the data streams of one run of an instance say of it. Pure: it is told
/// what its skill has measured, and the time.
///
/// A bound counts as broken when it has been for longer than the policy's
/// grace; one good value ends that. Where an input breaks one the instance is
/// starved. Where an output does it is unhealthy, but only if every input has
/// been fine for as long: what gets nothing, or has got nothing until now,
/// cannot give anything. Inputs without bounds are fine.
class health_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// After a silence that is so much longer than the grace, what was told
  /// before counts no more: nobody knows what the streams did meanwhile.
  static constexpr std::chrono::seconds silence_beyond_grace{5};

  /// `upstream_steps` say of the inputs, in their order, what writes them, e.g.
  /// "it is fed by step 'camera'"; there may be fewer, and empty ones. The age
  /// of a stream that has had no frame counts from `ready_since`. `before` is
  /// what was said of this run by an earlier process of the node.
  health_table(const instance_spec& spec, time_point ready_since,
               std::vector<std::string> upstream_steps = {},
               health_verdict before = {});

  /// Returns true when `last` has changed: the health, or which stream it is.
  /// Streams that are not told of are not judged.
  bool hear(const std::vector<stream_metrics>& reported, time_point now);

  const health_verdict& last() const {
    return last_;
  }

private:
  struct stream {
    std::string end;  ///< As in `stream_metrics`.
    std::string name; ///< "input '/scene/image'"
    stream_bounds bounds;
    std::string upstream_step;
    bool is_input = false;
    std::optional<time_point> broken_since;
  };

  double age_of(const stream_metrics& measured, time_point now) const;
  bool breaks(const stream& x, const stream_metrics& measured,
              time_point now) const;
  void update(const std::vector<stream_metrics>& reported, time_point now);
  bool any_input_is_broken() const;
  const stream* first_breach(time_point now) const;
  std::string sentence_on(const stream& x, const stream_metrics& measured,
                          time_point now) const;

  std::vector<stream> streams_; ///< Only those with bounds, inputs first.
  std::chrono::steady_clock::duration grace_;
  time_point ready_since_;
  std::optional<time_point> heard_;
  std::string blamed_; ///< The stream of `last_`; empty: none is known.
  health_verdict last_;
};

/// Whether the node's own discovery server knows the topics of one run of an
/// instance. What it does not know nobody else hears of, so that no data flow
/// that did not flow before. A server that has begun anew knows its programs
/// again once they have announced themselves, some seconds later. Pure: it is
/// told the time.
class server_sight {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// So long something may be missing.
  static constexpr std::chrono::seconds grace{10};

  /// `was_missed`: an earlier process of the node has said so of this run.
  explicit server_sight(bool was_missed) : misses_(was_missed) {}

  /// This of its topics is not known now: "a writer of /scene_1/image".
  void hear(std::vector<std::string> missing, time_point now);

  /// Returns true when what is to be said has changed. It is called whenever
  /// the skill has given a sign of life.
  bool judge(time_point now);

  /// One sentence without a full stop; empty: nothing is missed.
  std::string reason() const;

private:
  bool heard_ = false;
  std::vector<std::string> missing_;
  std::optional<time_point> since_;
  bool misses_;
};

} // namespace roscell
