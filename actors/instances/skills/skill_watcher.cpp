#include "actors/instances/skills/skill_watcher.hpp"

#include "actors/core/skill_changes.hpp"
#include "messages/event_kinds.hpp"

#include <caf/send.hpp>

#include <utility>
#include <vector>

namespace roscell {

namespace {

using watcher_pointer =
    skill_watcher_actor::stateful_pointer<skill_watcher_state>;

/// Folders may come while they are being watched: those, too, before they are
/// read.
std::string follow_folders(folder_watch& watch, const skill_places& places) {
  constexpr int most_rounds = 4;
  std::vector<watched_folder> followed;
  std::string problem;
  for (int i = 0; i < most_rounds; ++i) {
    auto wanted = places.to_watch();
    if (i > 0 && wanted == followed)
      break;
    followed = std::move(wanted);
    problem = watch.follow(followed);
  }
  return problem;
}

void watch_folders(watcher_pointer self) {
  auto& st = self->state;
  if (!st.watch)
    return;
  const auto problem = follow_folders(*st.watch, st.config.places);
  if (std::exchange(st.unwatched, problem) != problem && !problem.empty())
    st.config.context.publish_event(
        events::skills_not_watched, st.config.node,
        {{"reason", problem},
         {"hint", "send the node SIGHUP when skills have changed"}});
}

void publish_change(watcher_pointer self, const event_kind& what,
                    const installed_skill& skill,
                    const skill_catalogue& where) {
  const auto& config = self->state.config;
  config.context.publish_event(
      what, skill.descriptor.operation,
      {{"node", config.node},
       {"hash", skill.hash},
       {"version", skill.version},
       {"path", where.find(skill.hash)->path.string()}});
}

void publish_changes(watcher_pointer self, const skill_catalogue& before,
                     const skill_catalogue& now) {
  const auto changes = changes_between(before.skills(), now.skills());
  for (const auto& x : changes.removed)
    publish_change(self, events::skill_removed, x, before);
  for (const auto& x : changes.added)
    publish_change(self, events::skill_added, x, now);
  now.publish_problems(self->state.config.context, before);
}

skills_changed word_of(const skill_catalogue& skills) {
  return {skills.skills(), skills.published_problems()};
}

void read_folders(watcher_pointer self, bool is_quiet) {
  auto& st = self->state;
  ++st.readings;
  watch_folders(self);
  const auto before = st.config.skills->get();
  auto now = before->scan_again(st.config.places.present(), is_quiet);
  publish_changes(self, *before, now);
  auto word = word_of(now);
  st.config.skills->set(
      std::make_shared<const skill_catalogue>(std::move(now)));
  if (word == st.reported)
    return;
  st.reported = std::move(word);
  self->send(st.config.listener, st.reported);
}

void set_timer(watcher_pointer self) {
  auto& st = self->state;
  if (const auto due = st.unrest.due(); due != alarm::time_point::max())
    st.timer.set(self, due);
}

void on_touched(watcher_pointer self) {
  self->state.unrest.touch(self->clock().now());
  set_timer(self);
}

void on_tick(watcher_pointer self, uint64_t number) {
  auto& st = self->state;
  if (!st.timer.rings(number))
    return;
  const auto now = self->clock().now();
  if (now >= st.unrest.due())
    read_folders(self, st.unrest.begin_reading(now));
  set_timer(self);
}

/// It is told again even where no skill has changed: whoever hears of it asks
/// what else the node has become, such as its labels.
void take_places(watcher_pointer self, const use_settings& settings) {
  auto& st = self->state;
  auto& named = st.config.places.named;
  named.assign(settings.skill_dirs.begin(), settings.skill_dirs.end());
  const auto before = st.reported;
  read_folders(self, true);
  if (st.reported == before)
    self->send(st.config.listener, st.reported);
}

} // namespace

skill_watcher_actor::behavior_type
skill_watcher(watcher_pointer self, const skill_watcher_config& config) {
  auto& st = self->state;
  st.config = config;
  st.reported = word_of(*config.skills->get());
  if (config.io)
    st.watch.emplace(config.io, [me = skill_watcher_actor{self}] {
      caf::anon_send(me, skill_folders_touched{});
    });
  // They may have changed since they were read at first.
  read_folders(self, true);
  return {
      [self](const state_query&) {
        const auto& state = self->state;
        return state_of({{"skills", state.reported.skills.size()},
                         {"refused", state.reported.refused_skills.size()},
                         {"readings", state.readings},
                         {"unwatched", state.unwatched}});
      },
      [self](const skill_folders_touched&) { on_touched(self); },
      [self](const read_skills&) {
        read_folders(self, true);
        return skills_read{};
      },
      [self](const use_settings& x) { take_places(self, x); },
      [self](caf::tick_atom, uint64_t number) { on_tick(self, number); },
  };
}

} // namespace roscell
