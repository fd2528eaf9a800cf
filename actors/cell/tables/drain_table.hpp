#pragma once

#include "actors/core/backoff.hpp"
#include "messages/codec/described.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// That a node is to be empty, as it is stored.
struct drain_record {
  std::string node;
  std::string uuid;
  int64_t since_unix_ms = 0;

  static constexpr auto fields() {
    return field_list{required("node", &drain_record::node),
                      required("uuid", &drain_record::uuid),
                      required("since_unix_ms", &drain_record::since_unix_ms)};
  }
};

/// A node that is being emptied.
struct drained_node {
  drain_record record;
  bool moving = false; ///< Its instances are on their way.
  std::string problem; ///< Why they cannot go; empty: nothing is wrong.
  backoff pause = backoff{};
  std::chrono::steady_clock::time_point due; ///< Of the next attempt.
};

/// The nodes that take nothing new. Pure; told the time.
class drain_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// Null unless the node is to be empty.
  const drained_node* find(const std::string& uuid) const;

  /// False if it is so already.
  bool add(const drain_record& record, time_point now);
  void forget(const std::string& uuid);

  /// The next attempt begins.
  void begin(const std::string& uuid);

  /// It has come to its end: with a problem, or because something has come
  /// meanwhile, there is another one after a pause.
  void end(const std::string& uuid, const std::string& problem, bool is_empty,
           time_point now);

  size_t size() const {
    return nodes_.size();
  }

  /// All of them, the longest drained first.
  std::vector<drain_record> all() const;

  /// Those whose instances are to be moved now.
  std::vector<drain_record> due(time_point now) const;
  time_point next_due() const;

private:
  std::map<std::string, drained_node> nodes_; ///< By UUID.
};

} // namespace roscell
