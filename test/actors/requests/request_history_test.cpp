#include "actors/requests/request_history.hpp"
#include "messages/codec/json_codec.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using std::chrono::microseconds;

struct history_fixture {
  request_history table;
  request_history::time_point start{std::chrono::hours{1}};

  request_history::time_point at(int us) const {
    return start + microseconds{us};
  }

  request_history::ticket begin(const std::string& subject) {
    return table.begin("task_request", subject, 1000, start);
  }

  std::vector<request_trace> of(const std::string& subject) const {
    return table.traces(
        subject, [](uint64_t id) { return "actor " + std::to_string(id); });
  }
};

task_placement decision(const std::string& task, size_t bytes = 2) {
  return {task, 5, std::string(bytes, '1'), ""};
}

} // namespace

TEST_CASE_METHOD(history_fixture,
                 "A trace tells each hop, whom it asked, and how long it took",
                 "[request_history]") {
  const auto id = begin("t");
  table.enter(id, "claim", at(10));
  const auto asked = table.ask(id, 7, "", at(11));
  table.answer(asked, false, at(15));
  table.enter(id, "deploy", at(20));
  const auto late = table.ask(id, 8, "arm", at(21));
  table.answer(late, true, at(40));
  table.end(id, "timeout", at(50));
  const auto traces = of("t");
  REQUIRE(traces.size() == 1);
  const auto& x = traces[0];
  CHECK(x.request == "task_request");
  CHECK(x.came_unix_ms == 1000);
  CHECK(x.span_us == 50);
  CHECK(x.refusal == "timeout");
  REQUIRE(x.hops.size() == 2);
  CHECK(x.hops[0] == trace_hop{"claim", 10, 10, {{"actor 7", "", 11, 4}}});
  CHECK(x.hops[1]
        == trace_hop{"deploy", 20, 30, {{"actor 8", "arm", 21, 19, true}}});
}

TEST_CASE_METHOD(history_fixture,
                 "What goes on has no end, also while others come",
                 "[request_history]") {
  const auto id = begin("t");
  table.enter(id, "claim", at(1));
  table.ask(id, 7, "", at(2));
  begin("u");
  const auto x = of("t").at(0);
  CHECK(x.span_us == -1);
  CHECK(x.hops[0].span_us == -1);
  CHECK(x.hops[0].asked[0].span_us == -1);
}

TEST_CASE_METHOD(history_fixture, "An answer after the next hop is its own's",
                 "[request_history]") {
  const auto id = begin("t");
  table.enter(id, "undo", at(1));
  const auto asked = table.ask(id, 7, "", at(2));
  table.enter(id, "next", at(3));
  table.answer(asked, false, at(9));
  const auto x = of("t").at(0);
  CHECK(x.hops[0].asked[0].span_us == 7);
  CHECK(x.hops[1].asked.empty());
}

TEST_CASE_METHOD(history_fixture, "Traces are of one subject, or of all",
                 "[request_history]") {
  begin("t");
  begin("u");
  begin("t");
  CHECK(of("t").size() == 2);
  CHECK(of("").size() == 3);
  CHECK(of("v").empty());
}

TEST_CASE_METHOD(history_fixture,
                 "The oldest request goes when there are too many",
                 "[request_history]") {
  const auto first = begin("first");
  for (size_t i = 0; i < request_history::max_requests; ++i)
    begin("t");
  CHECK(of("first").empty());
  CHECK(of("").size() == request_history::max_requests);
  // What it still does is not anybody else's.
  table.enter(first, "claim", at(1));
  table.answer(table.ask(first, 7, "", at(2)), false, at(3));
  table.end(first, "", at(4));
  for (const auto& x : of(""))
    CHECK(x.hops.empty());
}

TEST_CASE_METHOD(history_fixture, "Hops and questions are bounded",
                 "[request_history]") {
  const auto id = begin("t");
  table.enter(id, "deploy", at(1));
  for (size_t i = 0; i < request_history::max_questions + 3; ++i)
    table.answer(table.ask(id, i, "", at(2)), false, at(3));
  const auto hop = of("t").at(0).hops.at(0);
  CHECK(hop.asked.size() == request_history::max_questions);
  CHECK(hop.dropped == 3);
  for (size_t i = 0; i < 2 * request_history::max_hops; ++i)
    table.enter(id, "again", at(4));
  CHECK(of("t").at(0).hops.size() == request_history::max_hops);
}

TEST_CASE_METHOD(history_fixture,
                 "Requests with many questions drive out the oldest ones",
                 "[request_history]") {
  constexpr size_t many = request_history::max_questions;
  constexpr size_t hops = request_history::max_hops;
  const auto work = [this](const std::string& subject) {
    const auto id = begin(subject);
    for (size_t i = 0; i < hops; ++i) {
      table.enter(id, "deploy", at(1));
      for (size_t j = 0; j < many; ++j)
        table.ask(id, j, "arm", at(2));
    }
  };
  constexpr size_t enough = request_history::max_parts / (hops * many);
  for (size_t i = 0; i < enough; ++i)
    work("t" + std::to_string(i));
  CHECK(of("").size() == enough);
  begin("next");
  CHECK(of("t0").empty());
  CHECK(of("next").size() == 1);
}

TEST_CASE_METHOD(history_fixture, "A request without a ticket leaves no trace",
                 "[request_history]") {
  table.enter(0, "claim", at(1));
  table.answer(table.ask(0, 7, "", at(2)), false, at(3));
  table.end(0, "", at(4));
  CHECK(of("").empty());
}

TEST_CASE_METHOD(history_fixture, "A task has its latest decision alone",
                 "[request_history]") {
  table.decide(decision("t"));
  table.decide({"t", 6, "", "{}"});
  const auto x = table.placement("t");
  REQUIRE(x);
  CHECK(x->decided_unix_ms == 6);
  CHECK(x->plan.empty());
  CHECK_FALSE(table.placement("u"));
}

TEST_CASE_METHOD(history_fixture,
                 "The oldest decisions go when they are too many or too large",
                 "[request_history]") {
  table.decide(decision("first"));
  for (size_t i = 0; i < request_history::max_placements; ++i)
    table.decide(decision("t" + std::to_string(i)));
  CHECK_FALSE(table.placement("first"));
  CHECK(table.placement("t0"));
  table.decide(decision("large", request_history::max_placement_bytes - 10));
  CHECK_FALSE(table.placement("t0"));
  CHECK(table.placement("large"));
  // One that is larger than all of the room is not kept at all.
  table.decide(decision("huge", request_history::max_placement_bytes));
  CHECK_FALSE(table.placement("huge"));
}

namespace {

json many_rejected() {
  auto result = json::array();
  for (size_t bytes = 0; bytes < 2 * request_history::max_decision_bytes;
       bytes += result.back().dump().size())
    result.push_back({{"step", "s" + std::to_string(result.size())},
                      {"reasons", {"needs 2 cores, 1.5 free"}}});
  return result;
}

} // namespace

TEST_CASE_METHOD(history_fixture,
                 "A large decision is cut, says so, and drives out no other",
                 "[request_history]") {
  table.decide(decision("small"));
  const auto rejected = many_rejected();
  const json plan{{"score", 1}, {"rejected", rejected}};
  const json error{
      {"type", "error"},
      {"error", {{"message", "it fits nowhere"}, {"rejected", rejected}}}};
  for (int i = 0; i < 3; ++i) {
    table.decide({"plan" + std::to_string(i), 5, plan.dump(), ""});
    table.decide({"error" + std::to_string(i), 5, "", error.dump()});
  }
  CHECK(table.placement("small"));
  CHECK(table.placement("plan0"));
  const auto kept = json::parse(table.placement("plan2")->plan);
  CHECK(kept["score"] == 1);
  CHECK(kept["rejected"].size() > 100);
  CHECK(kept["rejected"][99] == plan["rejected"][99]);
  const auto words = "of " + std::to_string(plan["rejected"].size())
                     + " rejected candidates, "
                     + std::to_string(kept["rejected"].size()) + " are kept";
  CHECK(kept["warnings"] == json{words});
  const auto refused = json::parse(table.placement("error2")->refusal);
  CHECK(refused["error"]["message"] == "it fits nowhere; " + words);
}

} // namespace roscell::test
