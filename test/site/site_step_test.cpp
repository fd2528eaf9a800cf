#include "actors/edge/session/limits.hpp"
#include "actors/session/limits.hpp"
#include "test/site/watch/site_watch.hpp"

#include <iostream>

/// Every party dies before and after every message of what a site does with a
/// node, and every message is lost, repeated and late. Whatever comes of it,
/// the site agrees in the end on where every node is.
namespace {

using namespace roscell;
using namespace roscell::test;

constexpr auto latency = 5ms;

/// Two cells of different sizes, a third coordinator, and a node.
struct step_site {
  site place;
  site_watch watch{place};
  site_party& from;
  site_party& to;
  site_party& asker;
  site_party& node;

  step_site(virtual_time& clock, const std::string& configured)
      : place(clock, 1), from(place.add_coordinator("c-1")),
        to(place.add_coordinator("c-0")), asker(place.add_coordinator("c-2")),
        node(place.add_node(configured)) {
    place.faults.shortest_delay = latency;
    place.faults.longest_delay = latency;
  }

  void start_coordinators() {
    for (auto& x : place.parties)
      if (x->coordinates)
        place.start(*x);
    place.pass(5s);
  }

  /// The node is in the cell `from`.
  void settle_node() {
    start_coordinators();
    place.start(node);
    place.pass(5s);
    REQUIRE(complaint(place).empty());
    REQUIRE(node.status().cell == from.cell);
    // Cells are looked at for evening out a little after they change.
    place.pass(10s);
  }
};

/// What is done with the node.
struct procedure {
  const char* name;
  std::function<std::unique_ptr<step_site>(virtual_time&)> prepare;
  std::function<void(step_site&)> begin;
};

std::unique_ptr<step_site> with_member(virtual_time& clock) {
  auto x = std::make_unique<step_site>(clock, "10.0.0.0:11811");
  x->settle_node();
  return x;
}

std::vector<procedure> procedures() {
  return {
      {"join by place",
       [](virtual_time& clock) {
         auto x = std::make_unique<step_site>(clock, "");
         // The coordinator that hands out places has a member already, so the
         // place is in another cell.
         x->place.add_node(x->to.discovery_server);
         x->start_coordinators();
         x->place.start(*x->place.parties.back());
         x->place.pass(10s);
         return x;
       },
       [](step_site& x) { x.place.start(x.node); }},
      {"formation of an unassigned node",
       [](virtual_time& clock) {
         auto x = std::make_unique<step_site>(clock, "wait");
         x->start_coordinators();
         x->place.start(x->node);
         x->place.pass(5s);
         return x;
       },
       [](step_site& x) {
         x.place.ask<cell_formed>(x.asker, cell_formation{{x.node.name}});
       }},
      {"formation of a member", with_member,
       [](step_site& x) {
         x.place.ask<cell_formed>(x.asker, cell_formation{{x.node.name}});
       }},
      {"transfer", with_member,
       [](step_site& x) {
         x.place.ask<node_transferred>(x.asker,
                                       node_transfer{x.node.name, x.to.cell});
       }},
      {"release", with_member,
       [](step_site& x) {
         x.place.ask<node_released>(x.asker, node_release{x.node.name});
       }},
  };
}

/// Long enough for each procedure to end without a problem.
constexpr auto procedure_span = 10s;

size_t count_messages(virtual_time& clock, const procedure& what) {
  auto x = what.prepare(clock);
  x->place.messages = 0;
  what.begin(*x);
  x->place.pass(procedure_span);
  CHECK(complaint(x->place).empty());
  return x->place.messages;
}

bool ends_well(step_site& x, const std::string& what) {
  auto left = calm_down(x.place);
  left += old_registrations(x.place);
  const auto lie = x.watch.longest_lie();
  const auto limit = limits::lease::span + site_watch::period
                     + limits::membership::registration + 1s;
  if (left.empty() && lie <= limit)
    return true;
  std::cerr << what << ": " << left << "longest lie " << lie.count() << " ms\n";
  print_events(x.place);
  return false;
}

enum class when { before, after };

/// Kills one party just before or after message `number` and starts it later.
bool survives_kill(virtual_time& clock, const procedure& what, size_t number,
                   size_t victim, when moment,
                   std::chrono::milliseconds absence) {
  auto x = what.prepare(clock);
  x->place.messages = 0;
  bool reached = false;
  bool is_write = false;
  std::string kind;
  x->place.judge = [&](const site_message& message) {
    if (message.number != number)
      return frame_fate::passed;
    reached = true;
    kind = message.what;
    is_write = kind == "write";
    const bool unsent = moment == when::before && message.from == victim;
    return unsent ? frame_fate::lost : frame_fate::passed;
  };
  what.begin(*x);
  x->place.pass_until(procedure_span, [&] { return reached; });
  if (moment == when::after && !is_write)
    x->place.pass(latency);
  x->place.judge = nullptr;
  x->place.kill(*x->place.parties[victim]);
  x->watch.live(absence);
  x->place.start(*x->place.parties[victim]);
  x->watch.live(2s);
  return ends_well(*x, std::string{what.name} + ", "
                           + x->place.parties[victim]->name + " killed "
                           + (moment == when::before ? "before" : "after") + " "
                           + kind + " " + std::to_string(number) + " for "
                           + std::to_string(absence.count()) + " ms");
}

bool survives_fate(virtual_time& clock, const procedure& what, size_t number,
                   frame_fate fate, std::chrono::milliseconds late_by = 3s) {
  auto x = what.prepare(clock);
  x->place.faults.late_by = late_by;
  x->place.messages = 0;
  x->place.judge = [&](const site_message& message) {
    return message.number == number ? fate : frame_fate::passed;
  };
  what.begin(*x);
  x->watch.live(procedure_span);
  return ends_well(*x, std::string{what.name} + ", message "
                           + std::to_string(number) + " with fate "
                           + std::to_string(static_cast<int>(fate)));
}

/// Hands every message of every procedure to `check`, and counts what failed.
unsigned failures(
    const std::function<bool(virtual_time&, const procedure&, size_t)>& check) {
  virtual_time clock;
  unsigned bad = 0;
  for (const auto& what : procedures()) {
    const auto count = count_messages(clock, what);
    INFO(what.name << " takes " << count << " messages");
    CHECK(count > 3);
    for (size_t number = 1; number <= count && bad < 20; ++number)
      bad += check(clock, what, number) ? 0 : 1;
  }
  return bad;
}

TEST_CASE("any party may die before or after any message", "[step]") {
  constexpr size_t parties = 4;
  const auto bad = failures([](auto& clock, const auto& what, size_t number) {
    bool well = true;
    for (size_t victim = 0; victim < parties; ++victim)
      for (const auto moment : {when::before, when::after})
        // Within a lease for one half, beyond it for the other.
        well &= survives_kill(clock, what, number, victim, moment,
                              (number + victim) % 2 == 0 ? 1s : 12s);
    return well;
  });
  CHECK(bad == 0);
}

TEST_CASE("any message may be lost, repeated or late", "[step]") {
  const auto bad = failures([](auto& clock, const auto& what, size_t number) {
    bool well = true;
    for (const auto fate :
         {frame_fate::lost, frame_fate::repeated, frame_fate::late})
      well &= survives_fate(clock, what, number, fate);
    // Longer than the wait for the answer to a registration.
    return survives_fate(clock, what, number, frame_fate::late, 5500ms) && well;
  });
  CHECK(bad == 0);
}

} // namespace
