#include "tools/roscell/insight/insight_views.hpp"

#include "test/words.hpp"

#include <catch2/catch.hpp>

namespace roscell::cli {

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
