#include "actors/cell/limits.hpp"
#include "actors/cell/tables/history_table.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

/// What has happened to tasks, also to those that are gone.
namespace roscell::test {

namespace {

event some_event(int64_t when, const std::string& what = "instance_changed") {
  return {0, when, what, "x", "{}"};
}

json history_of(const std::string& task) {
  return {{"type", "task_history_query"}, {"task", task}};
}

std::vector<std::string> history_lines(const json& history) {
  std::vector<std::string> result;
  for (const auto& x : history.at("events"))
    result.push_back(x.at("event"));
  return result;
}

} // namespace

TEST_CASE("A history keeps its first events and its newest ones",
          "[task_history]") {
  history_table table;
  constexpr auto bound =
      limits::task::first_events + limits::task::newest_events;
  size_t dropped = 0;
  for (size_t i = 0; i < bound + 30; ++i)
    dropped +=
        table.add("t", some_event(static_cast<int64_t>(i))).dropped.size();
  CHECK(dropped == 30);
  const auto known = table.find("t");
  REQUIRE(known);
  CHECK(known->events.size() == bound);
  CHECK(known->dropped == 30);
  CHECK(known->events.front().sequence == 1);
  CHECK(known->events.back().sequence == bound + 30);
}

TEST_CASE("A history that is read back goes on where it was",
          "[task_history]") {
  history_table before;
  std::vector<history_record> stored;
  std::set<std::string> gone;
  for (int i = 0; i < 300; ++i) {
    auto added = before.add("t", some_event(i));
    stored.push_back(added.record);
    gone.insert(added.dropped.begin(), added.dropped.end());
  }
  stored.erase(std::remove_if(stored.begin(), stored.end(),
                              [&](const auto& x) {
                                return gone.count(history_key(
                                           x.task, x.recorded.sequence))
                                       > 0;
                              }),
               stored.end());
  std::reverse(stored.begin(), stored.end());
  history_table after;
  after.restore(stored);
  CHECK(after.find("t") == before.find("t"));
  CHECK(after.add("t", some_event(300)).record.recorded.sequence == 301);
}

TEST_CASE("Histories of the tasks that something happened to last are kept",
          "[task_history]") {
  history_table table;
  for (size_t i = 0; i < limits::task::histories; ++i)
    table.add("t" + std::to_string(i), some_event(static_cast<int64_t>(i)));
  table.add("t0", some_event(10'000));
  const auto added = table.add("new", some_event(10'001));
  CHECK(added.dropped == std::vector<std::string>{history_key("t1", 1)});
  CHECK(table.find("t0"));
  CHECK_FALSE(table.find("t1"));
}

TEST_CASE("A task's story is told in order, also when it is gone",
          "[task_history]") {
  paper_cell x;
  auto& arm = x.add("arm");
  REQUIRE(x.request(echo_task("a", {echo_step("s0", 1, "arm")})).at("type")
          == "task_accepted");
  x.lose(arm);
  REQUIRE(x.enter(arm));
  x.request(termination("a"));
  const auto story = history_lines(x.request(history_of("a")));
  const std::vector<std::string> wanted{"instance_changed", "task_accepted",
                                        "instance_out_of_reach",
                                        "instance_changed", "task_terminated"};
  CHECK(story == wanted);
  CHECK(x.history.size() == wanted.size());
  CHECK(error_of(x.request(history_of("b"))) == "unknown_task");
}

} // namespace roscell::test
