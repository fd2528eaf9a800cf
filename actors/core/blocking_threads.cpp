#include "actors/core/blocking_threads.hpp"

#include <caf/scheduler/abstract_coordinator.hpp>

#include <algorithm>
#include <limits>
#include <system_error>
#include <thread>
#include <utility>

#include <pthread.h>

namespace roscell {

blocking_threads::blocking_threads(caf::actor_system& system)
    : caf::execution_unit(&system), outside_(&system) {
  // nop
}

void blocking_threads::enter() {
  const std::lock_guard lock{mutex_};
  ++actors_;
}

void blocking_threads::leave() {
  const std::lock_guard lock{mutex_};
  if (--actors_ > 0)
    return;
  for (auto* x : resting_)
    x->woken.notify_one();
}

void blocking_threads::exec_later(caf::resumable* job) {
  {
    const std::lock_guard lock{mutex_};
    const auto [at, is_new] = running_.try_emplace(job, false);
    if (!is_new) {
      at->second = true;
      return;
    }
    if (!resting_.empty()) {
      // The latest: those who have long rested can go on until they end.
      auto* const taken = resting_.back();
      resting_.pop_back();
      taken->job = job;
      taken->woken.notify_one();
      return;
    }
    ++threads_;
  }
  start(job);
}

std::size_t blocking_threads::size() const {
  const std::lock_guard lock{mutex_};
  return threads_;
}

void blocking_threads::start(caf::resumable* job) {
  // The actor system waits for its detached threads at its end.
  system().inc_detached_threads();
  try {
    std::thread{[self = shared_from_this(), job] {
      pthread_setname_np(pthread_self(), "roscell-blocks");
      self->system().thread_started();
      self->work(job);
      self->system().thread_terminates();
      self->system().dec_detached_threads();
    }}.detach();
  } catch (const std::system_error&) {
    system().dec_detached_threads();
    {
      const std::lock_guard lock{mutex_};
      --threads_;
      running_.erase(job);
    }
    // No thread can be had: better a worker that is blocked than an actor that
    // does not answer.
    system().scheduler().enqueue(job);
  }
}

void blocking_threads::work(caf::resumable* job) {
  for (; job != nullptr; job = job_after(job))
    run(job);
}

void blocking_threads::run(caf::resumable* job) {
  constexpr auto all = std::numeric_limits<std::size_t>::max();
  while (job->resume(&outside_, all) == caf::resumable::resume_later)
    continue;
  intrusive_ptr_release(job);
}

/// The former job may be gone: it is no more than a name here.
caf::resumable* blocking_threads::job_after(caf::resumable* done) {
  std::unique_lock lock{mutex_};
  const auto former = running_.find(done);
  if (std::exchange(former->second, false))
    return done;
  running_.erase(former);
  resting self;
  resting_.push_back(&self);
  const auto is_woken = [&] { return self.job != nullptr || actors_ == 0; };
  if (!self.woken.wait_for(lock, longest_rest, is_woken)
      && resting_.size() == 1)
    self.woken.wait(lock, is_woken);
  if (self.job == nullptr) {
    resting_.erase(std::find(resting_.begin(), resting_.end(), &self));
    --threads_;
  }
  return self.job;
}

} // namespace roscell
