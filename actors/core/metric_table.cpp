#include "actors/core/metric_table.hpp"

#include "actors/core/limits.hpp"

#include <algorithm>

namespace roscell {

const std::array<metric_family, metric_count>& metric_families() {
  static const std::vector<double> request_times{0.001, 0.005, 0.02, 0.1, 0.5,
                                                 2,     10,    60,   300};
  static const std::array<metric_family, metric_count> table{{
      {"roscell_requests",
       "Requests, by message type and outcome.",
       {"type", "outcome"},
       {}},
      {"roscell_request_duration_seconds",
       "Time to answer a request.",
       {"type"},
       request_times},
      {"roscell_allocations",
       "Searches for a placement, by their outcome.",
       {"outcome"},
       {}},
      {"roscell_allocation_duration_seconds",
       "Time of such a search.",
       {},
       {0.0001, 0.0005, 0.002, 0.01, 0.05, 0.2, 1}},
      {"roscell_allocation_states",
       "Branches that such a search looked at.",
       {},
       {1, 10, 100, 1000, 10'000, 100'000, 1'000'000}},
      {"roscell_session_sent_bytes",
       "Frames and heartbeats sent to another node, without headers.",
       {"peer"},
       {}},
      {"roscell_session_received_bytes",
       "Frames and heartbeats from another node, without headers.",
       {"peer"},
       {}},
      {"roscell_beats_sent",
       "Heartbeats sent that want an answer.",
       {"peer"},
       {}},
      {"roscell_beats_lost",
       "Heartbeats that were not answered.",
       {"peer"},
       {}},
      {"roscell_store_written_bytes", "Records given to the database.", {}, {}},
      {"roscell_builds_sent_bytes",
       "Parts of builds of skills given to who may have them.",
       {},
       {}},
      {"roscell_builds_received_bytes",
       "Parts of builds of skills fetched from another node.",
       {"source"},
       {}},
  }};
  return table;
}

void metric_table::add(metric which, label_values labels, double amount) {
  std::lock_guard guard{mutex_};
  find(which, labels).sum += amount;
}

void metric_table::observe(metric which, label_values labels, double value) {
  const auto& bounds = metric_families()[static_cast<size_t>(which)].buckets;
  std::lock_guard guard{mutex_};
  auto& sample = find(which, labels);
  sample.counts.resize(bounds.size() + 1);
  sample.sum += value;
  const auto bucket = std::lower_bound(bounds.begin(), bounds.end(), value);
  ++sample.counts[static_cast<size_t>(bucket - bounds.begin())];
}

std::vector<metric_sample> metric_table::samples(metric which) const {
  std::lock_guard guard{mutex_};
  std::vector<metric_sample> result;
  for (const auto& [labels, sample] : families_[static_cast<size_t>(which)])
    result.push_back(sample);
  return result;
}

metric_sample& metric_table::find(metric which, label_values labels) {
  auto& known = families_[static_cast<size_t>(which)];
  std::vector<std::string> key{labels.begin(), labels.end()};
  if (known.size() >= limits::metric::label_sets && known.count(key) == 0)
    std::fill(key.begin(), key.end(), "other");
  auto& result = known[key];
  result.labels = std::move(key);
  return result;
}

} // namespace roscell
