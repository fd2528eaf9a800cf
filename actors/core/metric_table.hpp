#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// What a node counts while it runs; `metric_families` describes each.
enum class metric : size_t {
  requests,
  request_seconds,
  allocations,
  allocation_seconds,
  allocation_states,
  session_sent_bytes,
  session_received_bytes,
  heartbeats_sent,
  heartbeats_lost,
  store_written_bytes,
  builds_sent_bytes,
  builds_received_bytes,
};

constexpr size_t metric_count = 12;

/// A family of samples that differ in their labels.
struct metric_family {
  const char* name; ///< Without the ending of a counter.
  const char* help;
  std::vector<const char*> labels;
  /// Upper bounds of a histogram's buckets, but for infinity; empty: a counter.
  std::vector<double> buckets;
};

/// In the order of `metric`.
const std::array<metric_family, metric_count>& metric_families();

/// One set of labels and what was counted for it.
struct metric_sample {
  std::vector<std::string> labels; ///< Values, in the order of the family's.
  double sum = 0;
  std::vector<uint64_t> counts; ///< Per bucket, infinity last; of histograms.
};

/// The node's counters. Any thread may count and read. Bounded: what has a new
/// set of labels when there are too many counts as "other".
class metric_table {
public:
  using label_values = std::initializer_list<std::string_view>;

  void add(metric which, label_values labels, double amount = 1);

  /// Of a histogram.
  void observe(metric which, label_values labels, double value);

  /// The samples of a family, in the order of their labels.
  std::vector<metric_sample> samples(metric which) const;

private:
  metric_sample& find(metric which, label_values labels);

  mutable std::mutex mutex_;
  std::array<std::map<std::vector<std::string>, metric_sample>, metric_count>
      families_;
};

} // namespace roscell
