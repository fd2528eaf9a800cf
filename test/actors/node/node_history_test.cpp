#include "actors/edge/history/limits.hpp"
#include "actors/node/node_history.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"
#include "test/fixture.hpp"

#include <chrono>
#include <string>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

struct history_fixture {
  temp_folder work;
  virtual_time time;
  std::shared_ptr<history_folder> folder = std::make_shared<history_folder>(
      work.path() / "history",
      history_bound{limits::history::least_bytes, 24h});
  node_history_actor history =
      spawn(time.system, time.context, node_history, folder);

  ~history_fixture() {
    time.kill(history);
  }

  /// A kept log that is larger than the bound allows.
  void keep_much(const std::string& name) {
    work.write("history/logs/" + name + "/log.0",
               std::string(2 * limits::history::least_bytes, 'x'));
    caf::anon_send(history, log_kept{});
    time.settle();
  }

  bool is_kept(const std::string& name) const {
    return std::filesystem::exists(work.path() / "history/logs" / name);
  }
};

} // namespace

TEST_CASE_METHOD(history_fixture,
                 "The bound is held soon after each log, and once a second",
                 "[history]") {
  time.advance(2s);
  keep_much("a@1");
  CHECK_FALSE(is_kept("a@1"));
  keep_much("b@2");
  keep_much("c@3");
  CHECK(is_kept("b@2"));
  time.advance(1s);
  CHECK_FALSE(is_kept("b@2"));
  CHECK_FALSE(is_kept("c@3"));
}

TEST_CASE_METHOD(history_fixture, "What has been written is read, part by part",
                 "[history]") {
  event_batch batch;
  for (uint64_t i = 1; i <= 2 * limits::history::part; ++i)
    batch.events.push_back({i, 1, "node_joined", "arm", ""});
  auto written = time.ask<events_written>(history, batch);
  time.settle();
  CHECK((*written)->value().set_aside > 2 * limits::history::part);
  auto past = time.ask<kept_events>(history, past_events_query{3, 0, 0});
  time.settle();
  const auto& events = (*past)->value().events;
  REQUIRE(events.size() == limits::history::part);
  CHECK(events[0].sequence == 4);
}

} // namespace roscell::test
