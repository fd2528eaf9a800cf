#include "test/site/site.hpp"

#include <algorithm>
#include <utility>

namespace roscell::test {

namespace {

/// A public announcement travels for so long, and the answer of a discovery
/// server.
constexpr auto presence_delay = 20ms;

std::pair<size_t, size_t> ordered(size_t x, size_t y) {
  return {std::min(x, y), std::max(x, y)};
}

} // namespace

bool site::passes(size_t from, size_t to) const {
  return (sides_.empty() || sides_[from] == sides_[to])
         && one_way_.count({from, to}) == 0;
}

bool site::sees(const site_party& viewer, const site_party& subject) const {
  const auto x = viewer.index;
  const auto y = subject.index;
  return passes(y, x) && hidden_.count(ordered(x, y)) == 0;
}

void site::split(const std::vector<int>& sides) {
  sides_ = sides;
  update_links();
}

void site::cut_one_way(size_t from, size_t to) {
  if (from != to)
    one_way_.emplace(from, to);
  update_links();
}

void site::update_links() {
  for (auto& c : connections) {
    auto& link = *c.link;
    const auto& [accepted, opened] = c.parties;
    const std::array<bool, 2> ends{!passes(accepted, opened),
                                   !passes(opened, accepted)};
    if (!ends[0] && !ends[1])
      heal(link);
    else
      mute(link, ends);
  }
  spread();
  for (auto& x : parties)
    look_up(*x);
}

void site::block(size_t x, size_t y) {
  blocked_.insert(ordered(x, y));
}

void site::hide(size_t x, size_t y) {
  hidden_.insert(ordered(x, y));
}

void site::heal_all() {
  blocked_.clear();
  hidden_.clear();
  one_way_.clear();
  for (auto& x : parties)
    thaw(*x);
  split({});
}

void site::show(site_party& viewer, const site_party& subject) {
  const auto what = *subject.announced;
  auto& known = viewer.shown[subject.index];
  if (known == what)
    return;
  known = what;
  later(viewer, presence_delay, [&viewer, who = subject.index, what] {
    const auto i = viewer.shown.find(who);
    if (i != viewer.shown.end() && i->second == what)
      caf::anon_send(viewer.brain(), presence_seen{what});
  });
}

void site::fade(site_party& viewer, size_t subject,
                std::chrono::milliseconds delay) {
  auto known = viewer.shown.extract(subject);
  if (known.empty())
    return;
  later(viewer, delay, [&viewer, subject, what = known.mapped()] {
    if (viewer.announced && viewer.shown.count(subject) == 0)
      caf::anon_send(viewer.brain(), presence_gone{what});
  });
}

void site::spread() {
  for (auto& viewer : parties) {
    if (!viewer->announced)
      continue;
    for (const auto& subject : parties)
      if (subject != viewer && subject->announced
          && subject->announced->role != "surveyor" && sees(*viewer, *subject))
        show(*viewer, *subject);
  }
}

void site::withdraw(site_party& x) {
  if (!std::exchange(x.announced, std::nullopt))
    return;
  x.shown.clear();
  for (auto& viewer : parties)
    fade(*viewer, x.index,
         sees(*viewer, x) ? std::chrono::milliseconds{presence_delay}
                          : std::chrono::milliseconds{ghost_span});
}

void site::look_up(site_party& x) {
  if (x.looking_for.empty())
    return;
  later(x, 115ms, [this, &x, wanted = x.looking_for] {
    for (const auto& c : parties)
      if (x.looking_for == wanted && c->discovery_server == wanted && c->alive()
          && reachable(x.index, c->index))
        caf::anon_send(x.membership,
                       coordinator_found{c->cell, c->name, c->address,
                                         c->cell_state().setup.incarnation});
  });
}

site_party* site::find_address(const std::string& address) {
  for (const auto& x : parties)
    if (x->address == address)
      return x.get();
  return nullptr;
}

wire_ptr site::connect(const site_party& from, const site_party& to) {
  const auto blocked = blocked_.count(ordered(from.index, to.index)) > 0;
  if (!to.alive() || blocked || !reachable(from.index, to.index))
    return nullptr;
  auto link = make_wire(time.system, context, random, faults);
  link->judge = [this, who = std::array{to.index, from.index}](size_t end) {
    return decide("frame", who[end], who[1 - end]);
  };
  connections.erase(std::remove_if(connections.begin(), connections.end(),
                                   [](const auto& c) {
                                     return !c.link->open && !c.link->silent;
                                   }),
                    connections.end());
  connections.push_back({link, {to.index, from.index}});
  return link;
}

bool site::has_lost(const std::string& cell, const std::string& node) const {
  for (const auto& x : parties)
    if (x->coordinator && x->cell == cell) {
      const auto* entry = x->cell_state().registry.find_name(node);
      return !entry || !entry->agent;
    }
  return false;
}

} // namespace roscell::test
