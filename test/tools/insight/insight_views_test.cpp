#include "test/printed_text.hpp"
#include "test/words.hpp"
#include "tools/roscell/insight/insight_views.hpp"

#include <catch2/catch.hpp>

namespace roscell::cli {

using test::cells_in;

namespace {

constexpr double mib = 1024 * 1024;

node_cost busy_node() {
  return {"base",
          {{"minute",
            75,
            0.15,
            8.1 * mib,
            750,
            {{"arm", 1440, 1417.5}, {"leg", 75, 0}}},
           {"day", 90'000, 90, 8 * mib, 0, {}}},
          ""};
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("Each window of a node's cost is a row of rates", "[tools]") {
  const auto text = cost_view({{busy_node()}}, {});
  CHECK(cells_in(text)
        == "NODE|WINDOW|SPAN|CPU (%)|PSS|WRITTEN A DAY|SENT (B/s)|"
           "RECEIVED (B/s)|PEERS (B/s)|BUILDS (B/s)\n"
           "base|minute|1m15s|0.2|8.1 MiB|844 KiB|20.2|"
           "18.9|arm 19.2/18.9, leg 1/0|-\n"
           "base|day|1d01h|0.1|8 MiB|0 B|0|0|-|-\n");
  CHECK(test::right_aligned(text)
        == "SPAN|CPU (%)|PSS|WRITTEN A DAY|SENT (B/s)|RECEIVED (B/s)|"
           "BUILDS (B/s)");
}

TEST_CASE("Before any time has passed there is no rate", "[tools]") {
  const auto text =
      cost_view({{{"base", {{"minute", 0, 0, mib, 0, {}}}, ""}}}, {});
  CHECK(mentions(cells_in(text), "base|minute|0s|0|1 MiB|"));
}

TEST_CASE("What a node writes at its start is not told as that of a day",
          "[tools]") {
  const auto text = [](double span_s) {
    return cost_view({{{"base", {{"minute", span_s, 0, mib, 60, {}}}, ""}}},
                     {});
  };
  CHECK_FALSE(mentions(text(59), " KiB "));
  CHECK(mentions(text(60), " KiB "));
}

TEST_CASE("Why a node's cost is not known is told below the others",
          "[tools]") {
  const auto text =
      cost_view({{busy_node(), {"leg", {}, "node 'leg' is\naway"}}}, {});
  CHECK(mentions(text, "\n\nleg: node 'leg' is?away\n"));
}

TEST_CASE("a state has a line per member, and what is within is indented",
          "[tools]") {
  const auto state = json::parse(
      R"({"phase":"active","frames":{"open":2,"list":[1,2]},"lost":[]})");
  CHECK(state_text(state)
        == "frames:\n  list: 1, 2\n  open: 2\nlost: none\nphase: active\n");
}

TEST_CASE("a list that is long or of objects has a line per element",
          "[tools]") {
  CHECK(state_text(json::parse(R"([{"a":1},{"a":2}])"))
        == "-\n  a: 1\n-\n  a: 2\n");
  const json words(20, "twenty times");
  const auto text = state_text(json{{"words", words}});
  CHECK(text.find("words:\n  - twenty times\n") == 0);
}

TEST_CASE("a state of one value is one line, and harmless", "[tools]") {
  CHECK(state_text(json("")) == "-\n");
  CHECK(state_text(json::object()) == "none\n");
  CHECK(state_text(json{{"name", "a\x1b[2J"}}) == "name: a?[2J\n");
}

namespace {

request_trace deployment() {
  request_trace result;
  result.request = "task_request";
  result.subject = "t";
  result.span_us = 2'500'000;
  result.hops = {{"claim_task", 0, 900, {{"cell-coordinator", "", 12, 840}}},
                 {"deploy", 900, 2'499'100, {{"member", "arm", 950, -1}}, 2}};
  return result;
}

using roscell::test::has;

} // namespace

TEST_CASE("a span has the unit that fits it", "[tools]") {
  CHECK(span_text(0) == "0 us");
  CHECK(span_text(999) == "999 us");
  CHECK(span_text(12'340) == "12.3 ms");
  CHECK(span_text(2'500'000) == "2.5 s");
  CHECK(span_text(-1) == "-");
}

TEST_CASE("a trace names its hops and below each whom it asked", "[tools]") {
  const auto text = trace_view(deployment(), {});
  CHECK(has(text, "task_request 't'"));
  CHECK(has(text, "done after 2.5 s"));
  const auto claim = text.find("claim_task");
  const auto asked = text.find("cell-coordinator");
  const auto deploy = text.find("deploy");
  CHECK(claim < asked);
  CHECK(asked < deploy);
  CHECK(has(text, "no answer yet"));
  CHECK(has(text, "2 more questions"));
}

TEST_CASE("a trace says what came of the request", "[tools]") {
  auto trace = deployment();
  trace.refusal = "conflict";
  CHECK(has(trace_view(trace, {}), "refused: conflict after 2.5 s"));
  trace.span_us = -1;
  CHECK(has(trace_view(trace, {}), "is worked on"));
}

TEST_CASE("foreign words in a trace do no harm to a terminal", "[tools]") {
  auto trace = deployment();
  trace.subject = "t\x1b[2J";
  CHECK_FALSE(has(trace_view(trace, {}), "\x1b"));
}

} // namespace roscell::cli
