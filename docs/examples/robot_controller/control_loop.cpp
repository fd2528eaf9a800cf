#include "control_loop.hpp"

#include <pthread.h>
#include <sched.h>

#include <cerrno>
#include <ctime>

namespace {

constexpr long period_ns = 1'000'000;
constexpr long second_ns = 1'000'000'000;
constexpr double period_s = 1e-3;

timespec now() {
  timespec result{};
  ::clock_gettime(CLOCK_MONOTONIC, &result);
  return result;
}

timespec after(timespec x, long ns) {
  x.tv_nsec += ns;
  if (x.tv_nsec >= second_ns) {
    x.tv_nsec -= second_ns;
    ++x.tv_sec;
  }
  return x;
}

std::chrono::nanoseconds since(const timespec& then) {
  const auto x = now();
  return std::chrono::seconds{x.tv_sec - then.tv_sec}
         + std::chrono::nanoseconds{x.tv_nsec - then.tv_nsec};
}

} // namespace

void mailbox::write(const position& x) {
  x_ = x.x;
  y_ = x.y;
  z_ = x.z;
}

position mailbox::read() const {
  return {x_, y_, z_};
}

control_loop::control_loop(std::optional<unsigned> core) {
  const auto start = arm{}.wrist();
  goal_.write(start);
  wrist_.write(start);
  thread_ = std::thread{[this, core] {
    prepare(core);
    run();
  }};
}

control_loop::~control_loop() {
  stop();
}

void control_loop::prepare(std::optional<unsigned> core) {
  if (core) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(*core, &set);
    ::pthread_setaffinity_np(::pthread_self(), sizeof(set), &set);
  }
  sched_param request{};
  request.sched_priority = 80;
  real_time_ =
      ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &request) == 0;
}

void control_loop::run() {
  arm simulated;
  for (auto due = now(); !stopped_; due = after(due, period_ns)) {
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr)
           == EINTR) {
    }
    late_.add(since(due));
    simulated.move_towards(reach(goal_.read()));
    simulated.step(period_s);
    wrist_.write(simulated.wrist());
  }
}

const jitter& control_loop::stop() {
  stopped_ = true;
  if (thread_.joinable())
    thread_.join();
  return late_;
}
