#pragma once

#include "test/actors/fakes/coordinator_fakes.hpp"

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace roscell::test {

/// A program that runs on a fake node, until it is stopped, has finished, or
/// its own fence has ended it.
struct trial_program {
  using time_point = std::chrono::steady_clock::time_point;
  static constexpr auto never = time_point::max();

  instance_spec spec;
  bool is_ready = false;
  bool comes_up = true;        ///< What happens at `ready_at`.
  time_point ready_at = never; ///< While it starts.
  time_point ends_at = never;  ///< Of being stopped, safe, or finished.
  time_point fence = never;    ///< While its node is cut off.
  std::optional<caf::response_promise> deployed;
};

class trial_site;

/// A node whose programs watch each other, and not what the coordinator knows.
/// What it does it does in the order of a real one: a member that is lost fails
/// what it was asked for before it is told of.
class trial_node {
public:
  using time_point = trial_program::time_point;

  trial_node(trial_site& site, const std::string& name);

  /// It registers, and does what it is told.
  void join();

  /// Nothing passes any more. A broken connection is noticed at once, silence
  /// after a lease.
  void cut(bool is_broken);

  /// Does what is due by now.
  void work();
  time_point next_due() const;

  /// A program ends by itself, with 0.
  void finish(const std::string& instance);

  bool in_session() const {
    return session_;
  }

  /// Whether the coordinator has been told that nothing is heard of it.
  bool is_reported_lost() const {
    return reported_lost_;
  }

  const std::string& name() const {
    return identity_.name;
  }

  const std::map<std::string, trial_program>& programs() const {
    return programs_;
  }

  /// For the end of the trial.
  void drop_promises();

private:
  struct removal {
    caf::response_promise promise;
    std::vector<std::string> left;
    instances_removed reply;
  };

  caf::behavior act(caf::event_based_actor* self);
  void inside(std::function<void()> work);
  void begin(const instance_spec& spec,
             std::optional<caf::response_promise> deployed);
  void end(const std::string& instance, instance_state state,
           const std::string& reason);
  void report_row(const instance_row& row);
  void on_deployment(caf::response_promise promise, const instance_spec& spec);
  void on_removal(caf::response_promise promise, const instance_removal& what);
  void on_switch(caf::response_promise promise,
                 const registration_switch& order);
  void settle_removals();
  void obey(const node_registered& reply);
  void lose_session();
  void report_loss();
  void set_fences(time_point proven);
  resource_report report() const;
  instance_row row(const trial_program& x) const;
  bool takes_order();
  bool is_reached_by(caf::response_promise promise);

  trial_site& site_;
  node_identity identity_;
  caf::actor actor_;
  bool reported_lost_ = false;
  bool session_ = false;   ///< The coordinator has it.
  bool linked_ = false;    ///< Packets pass.
  bool departing_ = false; ///< It was told to go.
  time_point proven_;      ///< When the last word that was answered was sent.
  int64_t silent_ms_ = 0;
  time_point lost_at_ = trial_program::never;
  std::map<std::string, trial_program> programs_;
  /// What its fence has ended, by instance: it is started again where it is
  /// still wanted.
  std::map<std::string, instance_spec> fenced_;
  std::vector<instance_row> untold_; ///< Ends of the time without a session.
  std::vector<removal> removals_;
  std::vector<caf::response_promise> unanswered_;
  std::vector<std::function<void()>> todo_;
};

/// The nodes of a trial, and what was seen on them.
class trial_site {
public:
  trial_site(paper_cell& cell, uint32_t seed, bool reports);

  trial_node& add(const std::string& name);

  /// Lets time pass, each node working when it is due.
  void live(std::chrono::milliseconds span);

  /// A program begins: nothing else of its step may run, but the one whose
  /// place it takes, on a node that is there, where nothing has to be
  /// stop-safe.
  void watch_start(const trial_node& on, const instance_spec& spec);

  uint32_t pick(uint32_t end) {
    return std::uniform_int_distribution<uint32_t>{0, end - 1}(random_);
  }

  /// True so many times in a hundred.
  bool chance(uint32_t percent) {
    return pick(100) < percent;
  }

  void note(const std::string& what);

  trial_program::time_point now() {
    return cell.time.scheduler.clock().now();
  }

  paper_cell& cell;
  std::vector<std::unique_ptr<trial_node>> nodes;
  std::string fault; ///< The first; empty: none.
  size_t starts = 0;

private:
  std::minstd_rand random_;
  trial_program::time_point begun_;
  bool reports_;
};

} // namespace roscell::test
