#include "actors/instances/skills/skill_watcher.hpp"

#include "test/actors/fakes/supervision_fakes.hpp"

#include <filesystem>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

namespace {

/// A watcher of one directory, of whose changes the test tells it.
struct watcher_bench : virtual_time {
  watcher_bench() {
    write("echo");
    log = system.spawn([this]() -> caf::behavior {
      return {[this](const record_event& x) { events.push_back(x); }};
    });
    context.events = caf::actor_cast<event_log_actor>(log);
    listener = system.spawn([this]() -> skill_listener_actor::behavior_type {
      return {[this](const skills_changed& x) { reported.push_back(x); }};
    });
    config.context = context;
    config.node = "arm";
    config.places.named = {folder.path()};
    config.skills = std::make_shared<current_skills>(
        std::make_shared<const skill_catalogue>(
            skill_catalogue::scan({folder.path()})));
    config.listener = listener;
  }

  ~watcher_bench() {
    kill(watcher);
    kill(listener);
    kill(log);
  }

  void start() {
    watcher = spawn_blocking(system, context, skill_watcher, config);
    settle();
  }

  void write(const std::string& name) const {
    folder.write(name + "/skill.json", echo_descriptor());
    folder.write(name + "/bin/echo", "#!/bin/sh\n", true);
  }

  void touch() {
    caf::anon_send(watcher, skill_folders_touched{});
    settle();
  }

  std::string hash() const {
    return config.skills->get()->skills().at(0).hash;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const auto& x : events)
      result.push_back(x.what);
    return result;
  }

  temp_folder folder;
  std::vector<skills_changed> reported;
  std::vector<record_event> events;
  caf::actor log;
  skill_listener_actor listener;
  skill_watcher_config config;
  skill_watcher_actor watcher;
};

} // namespace

TEST_CASE_METHOD(watcher_bench, "an edited folder is another build once it is "
                                "quiet") {
  start();
  const auto before = hash();
  folder.write("echo/extra", "");
  touch();
  advance(250ms);
  CHECK(reported.empty());
  touch(); // It goes on.
  advance(250ms);
  CHECK(reported.empty());
  advance(100ms);
  REQUIRE(reported.size() == 1);
  CHECK(reported[0].skills.at(0).hash == hash());
  CHECK(hash() != before);
  CHECK(names() == std::vector<std::string>{"skill_removed", "skill_added"});
  CHECK(events[1].subject == "echo");
  const auto data = json::parse(events[1].data);
  CHECK(data.at("node") == "arm");
  CHECK(data.at("hash") == hash());
  CHECK(data.at("path") == folder / "echo");
}

TEST_CASE_METHOD(watcher_bench, "who holds the folder of a build has it as it "
                                "was") {
  start();
  const auto before = hash();
  const auto kept = config.skills->get()->find(before);
  fs::remove_all(folder.path() / "echo");
  touch();
  advance(1s);
  CHECK(config.skills->get()->find(before) == nullptr);
  CHECK(kept->skill.hash == before);
}

TEST_CASE_METHOD(watcher_bench,
                 "nothing is reported where nothing has changed") {
  start();
  touch();
  advance(1s);
  CHECK(reported.empty());
  CHECK(events.empty());
}

TEST_CASE_METHOD(watcher_bench, "what has changed before it began is seen") {
  folder.write("echo/extra", "");
  start();
  CHECK(reported.size() == 1);
}

TEST_CASE_METHOD(watcher_bench, "a half-copied folder is blamed when it is "
                                "quiet, and the blame goes") {
  start();
  folder.write("new/skill.json", echo_descriptor());
  for (int i = 0; i < 26; ++i) {
    touch();
    advance(200ms);
  }
  // It was read once in between.
  CHECK(reported.empty());
  CHECK(events.empty());
  advance(1s);
  REQUIRE(reported.size() == 1);
  CHECK(reported[0].refused_skills.size() == 1);
  CHECK(names() == std::vector<std::string>{"skill_refused"});
  write("new");
  folder.write("new/extra", "");
  touch();
  advance(1s);
  REQUIRE(reported.size() == 2);
  CHECK(reported[1].refused_skills.empty());
  CHECK(reported[1].skills.size() == 2);
  CHECK(names() == std::vector<std::string>{"skill_refused", "skill_added"});
}

TEST_CASE_METHOD(watcher_bench, "the same problem is reported once") {
  start();
  folder.write("new/skill.json", "{");
  for (int i = 0; i < 3; ++i) {
    touch();
    advance(1s);
  }
  CHECK(reported.size() == 1);
  CHECK(events.size() == 1);
}

TEST_CASE_METHOD(watcher_bench, "other directories are read at once") {
  start();
  temp_folder other;
  other.write("more/skill.json", echo_descriptor());
  other.write("more/bin/echo", "#!/bin/sh\nexit\n", true);
  use_settings settings;
  settings.skill_dirs = {other.path()};
  caf::anon_send(watcher, settings);
  settle();
  REQUIRE(reported.size() == 1);
  REQUIRE(reported[0].skills.size() == 1);
  CHECK(config.skills->get()->find(reported[0].skills[0].hash)->path
        == other.path() / "more");
}

TEST_CASE("what is watched are directories, skills, and what may become one") {
  temp_folder folder;
  folder.write("dir/echo/skill.json", echo_descriptor());
  folder.write("dir/notes/readme", "");
  folder.write("dir/file", "");
  const skill_places places{{folder.path() / "dir"}, {folder.path() / "none"}};
  CHECK(places.to_watch()
        == std::vector<watched_folder>{{folder.path() / "dir"},
                                       {folder.path() / "none"},
                                       {folder.path() / "dir/echo", true},
                                       {folder.path() / "dir/notes"}});
  CHECK(places.present() == std::vector<fs::path>{folder.path() / "dir"});
}
