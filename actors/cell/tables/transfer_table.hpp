#pragma once

#include "actors/core/backoff.hpp"
#include "messages/codec/described.hpp"
#include "messages/failure.hpp"
#include "messages/formation.hpp"
#include "messages/inside/storage.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

struct cell_transfer;

/// Called once: when the transfer has ended, could not begin, or nothing of it
/// is known in time; with the transfer as it is then.
using transfer_done =
    std::function<void(const cell_transfer&, const completion&)>;

/// A transfer, or a release: that has no target. See docs/protocols.md.
struct cell_transfer {
  transfer_row row;
  bool kept = false; ///< The store has it. Before that nobody is told of it.
  /// Of `preparing`: then the node stays. Of `switching`: then it is
  /// `unresolved` for whoever waits.
  std::chrono::steady_clock::time_point deadline =
      std::chrono::steady_clock::time_point::max();
  std::vector<std::string> terminated;  ///< Tasks; nothing brings them back.
  std::vector<std::string> rescheduled; ///< Tasks.
  std::vector<transfer_done> waiting;
};

bool is_open(transfer_state x);

/// What the store keeps of a transfer.
store_record record_of(const transfer_row& row);

/// The transfers and releases of a cell's own members. A node has one open
/// transfer at most, and so many that have ended are remembered. Whoever goes
/// on with a transfer asks for it by `find_open` first: it may have ended while
/// an answer was on its way. Pure: it is told the time.
class transfer_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// @param cell, incarnation make the ids unique.
  explicit transfer_table(std::string cell = {}, int64_t incarnation = 0);

  /// An id for a transfer or for an order to come.
  std::string new_id();

  /// What an earlier run of the coordinator has stored.
  void restore(const transfer_row& row);

  // -- how one begins ---------------------------------------------------------

  /// Holds the node for a transfer that is `preparing`. Once the row is kept
  /// follows `open`, if it cannot be, `withdraw`.
  const transfer_row& propose(const std::string& node, const std::string& uuid,
                              const std::string& to, int64_t unix_ms);
  void open(const std::string& id);
  std::vector<transfer_done> withdraw(const std::string& id);

  /// The id of what holds the node, kept or not yet; empty if nothing does.
  std::string holder_of(const std::string& uuid) const;

  /// Whether that is more than a transfer of which nothing is known any more.
  bool is_busy(const std::string& uuid) const;

  /// Not kept yet; null if that is over.
  cell_transfer* find_proposed(const std::string& id);

  // -- how it goes on ---------------------------------------------------------

  /// Null once it has ended.
  cell_transfer* find_open(const std::string& id);

  /// The open one of that node; null if there is none.
  cell_transfer* find_open_of(const std::string& uuid);

  /// The row as it will be once the node is told to go.
  transfer_row switching_row(const cell_transfer& x, int64_t unix_ms) const;

  /// That row is kept: from now on the node has its time.
  void begin_switch(cell_transfer& x, const transfer_row& row, time_point now);

  /// Ids of those whose time is over.
  std::vector<std::string> overdue(time_point now) const;
  time_point next_deadline() const;

  /// Nothing is known in time. Gives those who wait; the transfer stays open.
  std::vector<transfer_done>
  set_unresolved(cell_transfer& x, const std::string& reason, int64_t unix_ms);

  // -- how it ends ------------------------------------------------------------

  /// The transfer as it has ended, with those who wait; none if it had ended
  /// before. @param state `done` or `returned`.
  std::optional<cell_transfer> end(const std::string& id, transfer_state state,
                                   const std::string& reason, int64_t unix_ms);

  /// Drops the oldest of the ended ones beyond the limit, and gives their ids.
  std::vector<std::string> forget_oldest();

  // -- what is told -----------------------------------------------------------

  /// The last transfer that took a node of that name out of this cell; null if
  /// none is remembered.
  const transfer_row* find_gone(const std::string& node) const;

  /// The oldest first; an empty id: all.
  std::vector<transfer_row> rows(const std::string& id = {}) const;

  size_t size() const {
    return transfers_.size();
  }

private:
  std::string prefix_;
  std::string cell_;
  uint64_t last_ = 0;
  std::map<std::string, cell_transfer> transfers_;
};

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

  /// What could not go is tried again now.
  void hurry(time_point now);

  time_point next_due() const;

private:
  std::map<std::string, drained_node> nodes_; ///< By UUID.
};

} // namespace roscell
