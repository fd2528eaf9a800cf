#pragma once

#include "test/site/watch/site_watch.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace roscell::test {

/// One run of random faults at one site; all of it comes from the seed.
class disturbance {
public:
  using duration = std::chrono::milliseconds;

  disturbance(virtual_time& clock, uint32_t seed);

  /// Starts everybody and disturbs them for a while.
  void run();

  /// Lets things calm down and says what is not as it shall be; empty: nothing.
  std::string verdict();

  site& place() {
    return place_;
  }

private:
  size_t pick(size_t count) {
    return place_.pick(count);
  }

  void add_faults();
  void add_parties();
  site_party& some_party();
  site_party& some_coordinator();
  site_party& some_node();

  void disturb();
  void disturb_party();
  void disturb_machine();
  void disturb_network();
  void disturb_wire();
  void split();
  void operate_nodes();
  void ask(const site_party& whom, const std::string& node);
  void operate_tasks();
  program_script some_script();
  void add_policies(json& step);
  json some_step(size_t number);
  void request_some_task(const site_party& whom);
  void request_burst(const site_party& whom);

  duration longest_honest_lie() const;
  std::string broken_limits() const;

  site place_;
  site_watch watch_;
  bool hostile_;
  bool has_tasks_;
  bool holds_ = false;
  size_t coordinators_ = 0;
};

} // namespace roscell::test
