#include "tools/roscell/view/event_text.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <ctime>

using namespace roscell;
using namespace roscell::cli;

namespace {

event sample(const char* what, const char* subject, const char* data) {
  return {7, 1795269787123, what, subject, data};
}

} // namespace

TEST_CASE("an event is complete at the empty line", "[tools]") {
  event_stream stream;
  CHECK_FALSE(stream.add_line("id: 3"));
  CHECK_FALSE(stream.add_line("event: node_joined"));
  CHECK_FALSE(stream.add_line(
      R"(data: {"sequence":3,"time_unix_ms":5,"event":"node_joined",)"));
  CHECK_FALSE(stream.add_line(R"(data:"subject":"arm-1","data":{"a":1}})"));
  const auto e = stream.add_line("");
  REQUIRE(e);
  CHECK(*e == event{3, 5, "node_joined", "arm-1", R"({"a":1})"});
}

TEST_CASE("comments and empty events are skipped", "[tools]") {
  event_stream stream;
  CHECK_FALSE(stream.add_line(": still here"));
  CHECK_FALSE(stream.add_line("\r"));
  CHECK_FALSE(stream.add_line("retry: 5"));
  CHECK_FALSE(stream.add_line(""));
}

TEST_CASE("data that is no event is skipped and the next one counts",
          "[tools]") {
  event_stream stream;
  for (const auto* data : {"data: nonsense", "data: [1]", "data: {}",
                           R"(data: {"sequence":"x"})"}) {
    CHECK_FALSE(stream.add_line(data));
    CHECK_FALSE(stream.add_line(""));
  }
  stream.add_line(
      R"(data: {"sequence":1,"time_unix_ms":1,"event":"x","subject":""})");
  CHECK(stream.add_line(""));
}

TEST_CASE("an event without end is not collected without end", "[tools]") {
  event_stream stream;
  const auto line = "data: " + std::string(1024 * 1024, ' ');
  for (int i = 0; i < 8; ++i)
    CHECK_FALSE(stream.add_line(line));
  CHECK_FALSE(stream.add_line(""));
}

TEST_CASE("an event line shows what a newer node tells", "[tools]") {
  setenv("TZ", "UTC", 1);
  tzset();
  const auto line = event_line(
      sample("moon_risen", "moon", R"({"phase":"full","n":3,"x":null})"));
  CHECK(line.find("2026-11-21 14:03:07.123") == 0);
  CHECK(line.find("moon_risen") != line.npos);
  CHECK(line.find("n=3 phase=full") != line.npos);
  CHECK(line.find("x=") == line.npos);
}

TEST_CASE("an event line is one line whatever the event holds", "[tools]") {
  const auto line =
      event_line(sample("a\nb", "c\x1b[2J", R"({"k":"v\nw","l":[1,2]})"));
  CHECK(line.find('\n') == line.npos);
  CHECK(line.find('\x1b') == line.npos);
  CHECK(line.find("l=(1, 2)") != line.npos);
}

TEST_CASE("an event line says where steps were placed", "[tools]") {
  const auto line = event_line(
      sample("allocation_chosen", "t",
             R"({"allocations":[{"bonus":0.0,"step":"camera","node":"head"},)"
             R"({"step":"poses","node":"arm"}],"optimal":true,)"
             R"("score":{"total":0.123456,"gap":0.0},"warnings":[]})"));
  CHECK(line.find("  camera→head, poses→arm optimal=yes score=0.1235")
        != line.npos);
  CHECK(line.find('{') == line.npos);
}

TEST_CASE("on a narrow terminal an event line has no date", "[tools]") {
  setenv("TZ", "UTC", 1);
  tzset();
  const auto e = sample("node_joined", "arm-1", "");
  CHECK(event_line(e, 119).find("14:03:07.123 ") == 0);
  CHECK(event_line(e, 120).find("2026-11-21 ") == 0);
  for (const size_t width : {80, 200})
    CHECK(event_line(e, width).find("node_joined")
          == event_heading(width).find("EVENT"));
}

TEST_CASE("an event line says what has become of a step", "[tools]") {
  const auto data = R"({"task":"t","step":"poses","state":"failed",)"
                    R"("node":"arm-1","reason":"no room","exit_code":3})";
  CHECK(event_particulars(sample("instance_changed", "t-poses-1", data))
        == "poses failed on arm-1 exit_code=3 reason=no room");
  CHECK(event_line(sample("instance_changed", "t-poses-1", data))
            .find("instance_changed      t                 poses failed")
        != std::string::npos);
}

TEST_CASE("no particular of an event is raw JSON", "[tools]") {
  CHECK(event_particulars(sample("x", "y", R"({"a":{"b":[1,"two",true]}})"))
        == "a=(b (1, two, yes))");
}

TEST_CASE("the heading stands above its columns", "[tools]") {
  const auto line = event_line(sample("node_joined", "arm-1", ""));
  CHECK(line.find("node_joined") == event_heading().find("EVENT"));
  CHECK(line.find("arm-1") == event_heading().find("SUBJECT"));
}

namespace {

using lines = std::vector<std::string>;

} // namespace

TEST_CASE("progress tells the step, its state and its node", "[tools]") {
  const auto e = sample("instance_changed", "t-poses-1",
                        R"({"task":"t","step":"poses","state":"starting",)"
                        R"("node":"arm-1"})");
  CHECK(progress_lines(e, "t") == lines{"step poses: starting on arm-1"});
}

TEST_CASE("progress tells why a step failed", "[tools]") {
  const auto e = sample("instance_changed", "t-poses-1",
                        R"({"task":"t","step":"poses","state":"failed",)"
                        R"("node":"arm-1","reason":"exited with code 3"})");
  CHECK(progress_lines(e, "t")
        == lines{"step poses: failed on arm-1: exited with code 3"});
}

TEST_CASE("progress tells where each step was placed", "[tools]") {
  const auto e = sample("allocation_chosen", "t",
                        R"({"allocations":[)"
                        R"({"step":"a","node":"n1","deployment":"cpu"},)"
                        R"({"step":"b","node":"n2","deployment":"gpu"}]})");
  CHECK(progress_lines(e, "t")
        == lines{"step a: placed on n1 (cpu)", "step b: placed on n2 (gpu)"});
}

TEST_CASE("progress tells events about the task itself", "[tools]") {
  CHECK(progress_lines(sample("task_accepted", "t", ""), "t")
        == lines{"task accepted"});
}

TEST_CASE("progress tells of a step once", "[tools]") {
  // The node says it without its name, the coordinator with it.
  const auto e = sample("instance_changed", "t-poses-1",
                        R"({"task":"t","step":"poses","state":"running"})");
  CHECK(progress_lines(e, "t").empty());
}

TEST_CASE("progress leaves out what concerns others", "[tools]") {
  CHECK(progress_lines(sample("task_accepted", "u", ""), "t").empty());
  CHECK(progress_lines(sample("node_joined", "arm-1", R"({"task":"u"})"), "t")
            .empty());
}

TEST_CASE("who waits for a task is told what is preempted for it", "[tools]") {
  CHECK(progress_lines(sample("instance_preempted", "low-a-1",
                              R"({"by":"t","task":"low","step":"a",)"
                              R"("node":"arm"})"),
                       "t")
        == std::vector<std::string>{"low/a is preempted on arm"});
}

TEST_CASE("who waits for nodes is told what happens to them", "[tools]") {
  const std::vector<std::string> nodes{"arm-1", "arm-2"};
  CHECK(movement_lines(sample("node_joined", "arm-2", R"({"epoch":3})"), nodes)
        == std::vector<std::string>{"arm-2: node joined"});
  CHECK(
      movement_lines(sample("transfer_ended", "arm-1",
                            R"({"state":"returned","reason":"no route"})"),
                     nodes)
      == std::vector<std::string>{"arm-1: transfer ended: returned: no route"});
  CHECK(movement_lines(sample("node_joined", "arm-3", "{}"), nodes).empty());
}
