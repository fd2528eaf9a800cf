#include "tools/roscell/daemon/node_process.hpp"

#include "actors/node/event_series.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

namespace {

event some_event(const char* what, const char* data) {
  return {1, 1, what, "arm-1", data};
}

} // namespace

TEST_CASE("the journal tells in sentences of the node's cell", "[tools]") {
  CHECK(journal_line(some_event("cell_joined",
                                R"({"cell":"lab","coordinator":"arm-2"})"))
        == "joined cell 'lab' of 'arm-2'");
  CHECK(journal_line(some_event("cell_left", R"({"cell":"lab"})"))
        == "left cell 'lab'");
  CHECK(journal_line(
            some_event("coordinator_lost",
                       R"({"cell":"lab","reason":"no heartbeat for 8 s"})"))
        == "lost cell 'lab': no heartbeat for 8 s");
  CHECK(journal_line(some_event("join_refused",
                                R"({"discovery_server":"10.0.0.1:11811",)"
                                R"("reason":"the site token is another one"})"))
        == "cannot join at 10.0.0.1:11811: the site token is another one");
  CHECK(journal_line(some_event("join_failed",
                                R"({"discovery_server":"10.0.0.1:11811",)"
                                R"("reason":"nothing listens there",)"
                                R"("hint":"is it running?","attempts":1})"))
        == "not joined yet at 10.0.0.1:11811: nothing listens there "
           "(is it running?)");
  CHECK(journal_line(
            some_event("join_failed", R"({"reason":"nobody is visible"})"))
        == "in no cell yet: nobody is visible");
}

TEST_CASE("the journal tells any other event with its particulars", "[tools]") {
  CHECK(journal_line(some_event("moon_risen", R"({"n":1})"))
        == "moon_risen 'arm-1' n=1");
  CHECK(journal_line(some_event("moon_risen", "")) == "moon_risen 'arm-1'");
}

TEST_CASE("a line of the journal is one line", "[tools]") {
  CHECK(journal_line(some_event("cell_left", "{\"cell\":\"a\\nb\"}"))
        == "left cell 'a?b'");
}

TEST_CASE("losses and failures are warnings", "[tools]") {
  for (const auto* what : {"node_lost", "coordinator_lost", "task_failed",
                           "join_refused", "join_failed"})
    CHECK(loudness_of(some_event(what, "")) == loudness::warning);
  CHECK(loudness_of(some_event("node_joined", "")) == loudness::info);
  CHECK(loudness_of(some_event("instance_changed", R"({"state":"failed"})"))
        == loudness::warning);
  CHECK(loudness_of(some_event("instance_changed", R"({"state":"running"})"))
        == loudness::debug);
}
