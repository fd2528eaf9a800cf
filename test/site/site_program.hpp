#pragma once

#include "messages/codec/json_codec.hpp"

#include <caf/event_based_actor.hpp>
#include <caf/message_handler.hpp>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

/// The only part of a node's supervision that is not real at a site: what runs.
namespace roscell::test {

class site;
struct site_party;

/// Cores that every machine uses for something else.
constexpr double idle_cpu = 0.5;

/// What a program does; a step says it in its parameters.
struct program_script {
  int64_t ready_ms = 200; ///< Negative: it never says READY=1.
  int64_t ends_ms = -1;   ///< After READY=1; negative: never by itself.
  int64_t exit_code = 0;
  int64_t stop_ms = 100; ///< Beyond the grace time it is killed.
  bool cannot_start = false;

  /// As a step's parameters.
  json parameters() const;
  static program_script from(const std::string& parameters);
};

/// A program on a machine, with what its shim keeps of it. It outlives the
/// node's process.
struct site_program {
  using time_point = std::chrono::steady_clock::time_point;

  std::string instance;
  std::string container;
  std::string cell;
  std::string task;
  std::string step;
  program_script script;
  std::optional<time_point> ready_at; ///< When it says READY=1.
  std::optional<time_point> ends_at;  ///< By itself.
  std::optional<time_point> fence;    ///< By its shim, unless moved on.
  bool ended = false;
  int exit_code = -1; ///< Of one that has ended.

  bool runs(time_point now) const {
    return !ended && (!ends_at || now < *ends_at) && (!fence || now < *fence);
  }
};

/// How a party's edge plays the runtime and the resource probe.
caf::message_handler program_edge(caf::event_based_actor* self, site* place,
                                  site_party* me);

/// The party's process has been started: its programs can be heard again.
void resume_programs(site& place, site_party& x);

/// The party's machine has lost its power.
void end_programs(site_party& x);

} // namespace roscell::test
