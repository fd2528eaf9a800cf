#include "actors/edge/session/limits.hpp"
#include "actors/session/lease.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <random>
#include <stdexcept>
#include <vector>

namespace {

using namespace roscell;
using namespace std::chrono_literals;

using time_point = lease::time_point;

/// Two leases and what flies between them, on virtual time.
struct pair_of_leases {
  struct packet {
    bool to_member;
    heartbeat_kind kind;
  };

  lease member{lease_side::member, time_zero};
  lease coordinator{lease_side::coordinator, time_zero};
  time_point now = time_zero;
  std::multimap<time_point, packet> flying;
  std::mt19937 random;
  double loss = 0;
  bool member_dead = false;
  bool coordinator_dead = false;
  size_t member_ticks = 0;
  size_t coordinator_ticks = 0;
  size_t packets = 0;
  bool member_lost = false;      ///< The coordinator thinks so.
  bool coordinator_lost = false; ///< The member thinks so.

  explicit pair_of_leases(unsigned seed) : random(seed) {}

  void send(bool to_member, heartbeat_kind kind) {
    ++packets;
    if (std::uniform_real_distribution<double>{}(random) < loss)
      return;
    const auto delay = std::chrono::milliseconds{1 + random() % 40};
    flying.emplace(now + delay, packet{to_member, kind});
  }

  void deliver(const packet& x) {
    if (x.to_member ? member_dead : coordinator_dead)
      return;
    auto& receiver = x.to_member ? member : coordinator;
    if (auto answer = receiver.heard_heartbeat(x.kind, now))
      send(!x.to_member, *answer);
  }

  void tick(lease& side, size_t& ticks, bool& lost, bool to_member) {
    ++ticks;
    const auto todo = side.due(now);
    lost = todo.over;
    if (todo.send)
      send(to_member, *todo.send);
    // Counted, for an assertion is dear where there are millions.
    if (!lost && side.next() <= now)
      throw std::logic_error{"the lease wants to be asked again at once"};
  }

  /// Handles the next thing; false when it is not before `end`.
  bool step(time_point end) {
    auto when = end;
    if (!member_dead)
      when = std::min(when, member.next());
    if (!coordinator_dead)
      when = std::min(when, coordinator.next());
    if (!flying.empty())
      when = std::min(when, flying.begin()->first);
    if (when >= end)
      return false;
    now = when;
    if (!flying.empty() && flying.begin()->first == now) {
      const auto x = flying.begin()->second;
      flying.erase(flying.begin());
      deliver(x);
    } else if (!member_dead && member.next() == now) {
      tick(member, member_ticks, coordinator_lost, false);
    } else {
      tick(coordinator, coordinator_ticks, member_lost, true);
    }
    return true;
  }

  /// Lets time pass until then, or until one side loses the other.
  void run(time_point end) {
    while (!member_lost && !coordinator_lost && step(end)) {
    }
    if (!member_lost && !coordinator_lost)
      now = end;
  }
};

TEST_CASE("an idle pair wakes for its heartbeat only") {
  pair_of_leases x{1};
  x.run(time_zero + 400s);
  CHECK_FALSE(x.member_lost);
  CHECK_FALSE(x.coordinator_lost);
  // One heartbeat and one ack each 4 s.
  CHECK(x.packets <= 200);
  CHECK(x.packets >= 196);
  // The member sends a heartbeat and looks once whether it was answered.
  CHECK(x.member_ticks <= 2 * 100);
  CHECK(x.coordinator_ticks <= 100);
}

TEST_CASE("a silent member is lost one lease after it was last heard") {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    pair_of_leases x{seed};
    x.run(time_zero + std::chrono::milliseconds{x.random() % 30'000});
    x.member_dead = true;
    const auto died = x.now;
    x.run(time_zero + 100s);
    CHECK(x.member_lost);
    // What flew when it died still counts.
    CHECK(x.now - died <= limits::lease::span + 40ms);
    CHECK(x.now - died
          >= limits::lease::span - limits::lease::heartbeat_period - 40ms);
  }
}

TEST_CASE("a silent coordinator is lost one lease after it was last heard") {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    pair_of_leases x{seed};
    x.run(time_zero + std::chrono::milliseconds{x.random() % 30'000});
    x.coordinator_dead = true;
    const auto died = x.now;
    x.run(time_zero + 100s);
    CHECK(x.coordinator_lost);
    CHECK(x.now - died <= limits::lease::span + 40ms);
    CHECK(x.now - died
          >= limits::lease::span - limits::lease::heartbeat_period - 90ms);
  }
}

TEST_CASE(
    "an outage of less than the lease without a heartbeat is not noticed") {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    pair_of_leases x{seed};
    x.run(time_zero + std::chrono::milliseconds{x.random() % 30'000});
    x.loss = 1;
    x.run(x.now + limits::lease::span - limits::lease::heartbeat_period
          - 2 * limits::lease::urgent_probe_interval);
    x.loss = 0;
    x.run(x.now + 60s);
    CHECK_FALSE(x.member_lost);
    CHECK_FALSE(x.coordinator_lost);
  }
}

TEST_CASE("a loss of 20 % in each direction never costs a member") {
  const auto seed = std::random_device{}();
  CAPTURE(seed);
  pair_of_leases x{seed};
  x.loss = 0.2;
  constexpr auto simulated = 3000h;
  x.run(time_zero + simulated);
  INFO("after " << std::chrono::duration<double>(x.now - time_zero).count()
                << " s");
  CHECK_FALSE(x.member_lost);
  CHECK_FALSE(x.coordinator_lost);
}

TEST_CASE("a probe is answered with a heartbeat and a heartbeat with an ack") {
  lease x{lease_side::coordinator, time_zero};
  CHECK(x.heard_heartbeat(heartbeat_kind::heartbeat, time_zero)
        == heartbeat_kind::ack);
  CHECK(x.heard_heartbeat(heartbeat_kind::probe, time_zero)
        == heartbeat_kind::heartbeat);
  CHECK(x.heard_heartbeat(heartbeat_kind::ack, time_zero) == std::nullopt);
}

TEST_CASE("after a miss the peer is asked until the lease is over") {
  lease x{lease_side::coordinator, time_zero};
  std::vector<std::chrono::milliseconds> asked;
  lease::step todo;
  auto now = time_zero;
  while (!todo.over) {
    now = x.next();
    todo = x.due(now);
    if (todo.send == heartbeat_kind::probe)
      asked.push_back(std::chrono::duration_cast<std::chrono::milliseconds>(
          now - time_zero));
  }
  REQUIRE(asked.size() > 2);
  CHECK(asked[0]
        == limits::lease::heartbeat_period + limits::lease::probe_interval);
  CHECK(asked[1] == asked[0] + limits::lease::probe_interval);
  CHECK(asked.back()
        == limits::lease::span - limits::lease::urgent_probe_interval);
  CHECK(now - time_zero == limits::lease::span);
}

TEST_CASE("any frame counts as a sign of life") {
  lease member{lease_side::member, time_zero};
  lease coordinator{lease_side::coordinator, time_zero};
  for (auto now = time_zero; now < time_zero + 60s; now += 3s) {
    member.heard(now);
    coordinator.heard(now);
    CHECK_FALSE(member.due(now).over);
    CHECK_FALSE(coordinator.due(now).send);
  }
}

} // namespace
