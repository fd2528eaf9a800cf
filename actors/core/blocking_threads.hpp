#pragma once

#include <caf/actor_system.hpp>
#include <caf/execution_unit.hpp>
#include <caf/resumable.hpp>
#include <caf/scoped_execution_unit.hpp>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace roscell {

/// The threads of the actors that block, on a disk or on a library. Such an
/// actor has a thread while it works, and none while it waits for a message:
/// the workers of the scheduler are never blocked, and an idle node does not
/// keep a thread for each of them.
///
/// There are never more threads than actors, as each of them works on one
/// thread at a time: none waits for another that hangs on a wedged disk. An
/// actor that has a message again before its thread has let go of it goes on
/// there, so it does not take a second one for that moment. A
/// thread that has rested for `longest_rest` ends, but for one that stays.
/// All end with the last actor.
class blocking_threads final
    : public caf::execution_unit,
      public std::enable_shared_from_this<blocking_threads> {
public:
  static constexpr std::chrono::seconds longest_rest{1};

  explicit blocking_threads(caf::actor_system& system);

  /// One more actor works here.
  void enter();

  /// An actor has ended.
  void leave();

  /// From any thread, and without waiting: has `job` resumed on a thread that
  /// rests, or on a new one. Takes over a reference to it.
  void exec_later(caf::resumable* job) override;

  /// How many threads there are now.
  std::size_t size() const;

private:
  struct resting {
    std::condition_variable woken;
    caf::resumable* job = nullptr;
  };

  void start(caf::resumable* job);

  /// The body of a thread.
  void work(caf::resumable* job);

  /// Until it has a message to wait for, or has ended.
  void run(caf::resumable* job);

  /// The next job of this thread after that one; null: it is to end.
  caf::resumable* job_after(caf::resumable* done);

  /// Where its actors send from: what they send to runs elsewhere.
  caf::scoped_execution_unit outside_;
  mutable std::mutex mutex_; // Guards what follows.
  std::size_t actors_ = 0;
  std::size_t threads_ = 0;
  std::vector<resting*> resting_; // Who has rested the longest comes first.
  /// What threads work on, and whether it is to be resumed once more.
  std::map<caf::resumable*, bool> running_;
};

} // namespace roscell
