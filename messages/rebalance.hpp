#pragma once

#include "messages/codec/described.hpp"
#include "messages/codec/json_codec.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// How the running steps of a cell are brought nearer to the best placement.
namespace roscell {

/// Plans moves of the cell's running steps, and makes them one after the other.
/// Answered at once; how it goes on is told by events. While one goes on, the
/// same request is answered with how far it is.
struct cell_rebalance {
  static constexpr const char* type = "cell_rebalance";
  bool dry_run = false;    ///< The moves are only shown.
  double min_gain = 0.01;  ///< No move gains a smaller part of the total.
  int64_t most_moves = 32; ///< 1 to 256.
  bool force = false;      ///< Nothing is waited for to be stop-safe.
  bool stop = false;       ///< The move that goes on is the last one.

  static constexpr auto fields() {
    return field_list{optional("dry_run", &cell_rebalance::dry_run),
                      optional("min_gain", &cell_rebalance::min_gain),
                      optional("most_moves", &cell_rebalance::most_moves),
                      optional("force", &cell_rebalance::force),
                      optional("stop", &cell_rebalance::stop)};
  }
};

enum class move_state {
  planned,
  moving,
  settling, ///< The new instance runs; it is to stay healthy for a while.
  done,
  failed,
};

constexpr auto enum_words(move_state) {
  return std::array<std::string_view, 5>{"planned", "moving", "settling",
                                         "done", "failed"};
}

/// One running step that goes to another node.
struct rebalance_move {
  std::string instance;
  std::string task;
  std::string step;
  std::string from; ///< Nodes.
  std::string to;
  double gain = 0; ///< What it takes off the total, after the moves before.
  move_state state = move_state::planned;

  static constexpr auto fields() {
    return field_list{required("instance", &rebalance_move::instance),
                      required("task", &rebalance_move::task),
                      required("step", &rebalance_move::step),
                      required("from", &rebalance_move::from),
                      required("to", &rebalance_move::to),
                      required("gain", &rebalance_move::gain),
                      optional("state", &rebalance_move::state)};
  }
};

/// Reply to `cell_rebalance`. The totals are those of equation (1) of the paper
/// for all running steps at once, in the order of their tasks.
struct cell_rebalanced {
  static constexpr const char* type = "cell_rebalanced";
  std::string cell;
  bool running = false; ///< Moves are being made.
  double before = 0;
  double after = 0;                  ///< Once all moves are made.
  double lower_bound = 0;            ///< No placement has a lower total.
  bool optimal = false;              ///< None has a lower one than `after`.
  std::vector<rebalance_move> moves; ///< In their order.
  std::string problem;               ///< Why it has ended before the last one.

  static constexpr auto fields() {
    return field_list{required("cell", &cell_rebalanced::cell),
                      required("running", &cell_rebalanced::running),
                      required("before", &cell_rebalanced::before),
                      required("after", &cell_rebalanced::after),
                      required("lower_bound", &cell_rebalanced::lower_bound),
                      required("optimal", &cell_rebalanced::optimal),
                      required("moves", &cell_rebalanced::moves),
                      optional("trouble", &cell_rebalanced::problem)};
  }
};

} // namespace roscell
