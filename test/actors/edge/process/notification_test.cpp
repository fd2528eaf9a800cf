#include "actors/edge/process/notification.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

TEST_CASE("a notification's known lines are read, in any order") {
  const auto x = parse_notification("WATCHDOG=1\nSTATUS=5 frames/s\nREADY=1");
  CHECK(x.ready);
  CHECK(x.alive);
  CHECK_FALSE(x.stopping);
  CHECK(x.status == "5 frames/s");
  CHECK(parse_notification("STOPPING=1\n").stopping);
}

TEST_CASE("unknown and malformed lines of a notification are ignored") {
  for (const std::string text :
       {"", "\n\n\n", "READY", "READY=0", "READY=11", " READY=1", "ready=1",
        "MAINPID=1", "=", "WATCHDOG=trigger", "STATUS"}) {
    const auto x = parse_notification(text + "\nX=1");
    CHECK_FALSE((x.ready || x.alive || x.stopping));
    CHECK(x.status.empty());
  }
}

TEST_CASE("a status is one line of valid UTF-8 of bounded length") {
  CHECK(parse_notification("STATUS=a\x01\x7Fz").status == "a  z");
  CHECK(parse_notification("STATUS=\xFF").status == "\xEF\xBF\xBD");
  const auto ascii = parse_notification("STATUS=" + std::string(3000, 'x'));
  CHECK(ascii.status.size() == max_status_bytes);
  const auto broken = parse_notification("STATUS=" + std::string(600, '\xFF'));
  CHECK(broken.status.size() == max_status_bytes / 3 * 3);
}

TEST_CASE("a notification longer than a datagram may be is ignored whole") {
  const std::string text = "READY=1\n";
  CHECK_FALSE(
      parse_notification(text + std::string(max_notification_bytes, 'x'))
          .ready);
}

TEST_CASE("a program tells whether it may be ended") {
  CHECK(parse_notification("ROSCELL_SAFE=1").safe == safe_word::safe);
  CHECK(parse_notification("ROSCELL_SAFE=0\n").safe == safe_word::unsafe);
  CHECK(parse_notification("ROSCELL_SAFE=0\nX=1\nROSCELL_SAFE=1").safe
        == safe_word::safe);
  for (const std::string text :
       {"READY=1", "ROSCELL_SAFE=", "ROSCELL_SAFE=2", "ROSCELL_SAFE=10",
        "ROSCELL_SAFE=yes", " ROSCELL_SAFE=1", "ROSCELL_SAFE"})
    CHECK(parse_notification(text).safe == safe_word::untold);
}

TEST_CASE("a program tells what its data streams do") {
  const auto reported = parse_notification(
      "ROSCELL_STREAMS=input:0 12.500 0.040;input:15 0 -;output:1 2 7.25");
  REQUIRE(reported.streams.size() == 3);
  CHECK(reported.streams[0].end == "input:0");
  CHECK(reported.streams[0].rate_hz == Approx(12.5));
  CHECK(reported.streams[0].age_s == Approx(0.04));
  CHECK(reported.streams[1].end == "input:15");
  CHECK(reported.streams[1].age_s < 0);
  CHECK(reported.streams[2].end == "output:1");
  CHECK(reported.streams[2].age_s == Approx(7.25));
}

TEST_CASE("of a line about streams that is broken nothing is believed") {
  const std::string good = "input:0 12.5 0.04";
  for (const std::string broken :
       {"output:0",       "output:0 1",     "output:0 1 2 3", "output:0  1 2",
        "output:0 -1 2",  "output:0 1 -2",  "output:0 -0 2",  "output:0 nan 2",
        "output:0 inf 2", "output:0 1 inf", "output:0 1e3 2", "output:0 1,5 2",
        "output:0 - 2",   "side:0 1 2",     "output: 1 2",    "output:+1 1 2",
        "output:123 1 2", "output 1 2",     "output:x 1 2",   ""}) {
    CAPTURE(broken);
    CHECK(parse_notification("ROSCELL_STREAMS=" + good + ";" + broken + ";"
                             + good)
              .streams.empty());
  }
  std::string many = "ROSCELL_STREAMS=";
  for (size_t i = 0; i < max_reported_streams; ++i)
    many += good + ";";
  CHECK(parse_notification(many).streams.size() == max_reported_streams);
  CHECK(parse_notification(many + good).streams.empty());
}

TEST_CASE("a program tells what has gone through its streams") {
  const auto reported = parse_notification(
      "ROSCELL_FRAMES=input:0 118 115 3 2 850;input:1 9 0 9 0 0;output:0 115\n"
      "ROSCELL_REMARK=118 frames in, none out: \x01 why");
  REQUIRE(reported.frames.size() == 3);
  CHECK(reported.frames[0].end == "input:0");
  CHECK(reported.frames[0].frames == 118);
  CHECK(reported.frames[0].processed == 115);
  CHECK(reported.frames[0].failed == 3);
  CHECK(reported.frames[0].dropped == 2);
  CHECK(reported.frames[0].latency_ms == Approx(0.85));
  CHECK(reported.frames[1].latency_ms < 0);
  CHECK(reported.frames[2].end == "output:0");
  CHECK(reported.frames[2].frames == 115);
  CHECK(reported.frames[2].processed < 0);
  CHECK(reported.remark == "118 frames in, none out:   why");
}

TEST_CASE("of counts that are broken none is trusted") {
  const std::string good = "output:0 7";
  for (const std::string text :
       {"", "output:0", "output:0 -1", "output:0 x", "output:0 1 2",
        "output:100 1", "input:0 1 2 3 4", "input:0 1 2 3 4 5 6", "middle:0 1",
        "output:0 9007199254740992", "output:0 1.5"})
    CHECK(
        parse_notification("ROSCELL_FRAMES=" + good + ";" + text).frames.size()
        == (text.empty() ? 1 : 0));
  std::string many = "ROSCELL_FRAMES=";
  for (size_t i = 0; i <= max_reported_streams; ++i)
    many += good + ";";
  CHECK(parse_notification(many).frames.empty());
}

TEST_CASE("a remark is bounded, and gone with the next status without one") {
  auto before = parse_notification("STATUS=a\nROSCELL_FRAMES=output:0 1\n"
                                   "ROSCELL_REMARK="
                                   + std::string(3000, 'x'));
  CHECK(before.remark.size() == max_remark_bytes);
  merge(before, parse_notification("WATCHDOG=1"));
  CHECK(before.frames.size() == 1);
  CHECK_FALSE(before.remark.empty());
  merge(before, parse_notification("STATUS=b"));
  CHECK(before.frames.empty());
  CHECK(before.remark.empty());
}

TEST_CASE("merged notifications keep the last word on safety and streams") {
  auto before = parse_notification("ROSCELL_SAFE=0\n"
                                   "ROSCELL_STREAMS=input:0 1 2;input:1 1 2");
  merge(before, parse_notification("WATCHDOG=1"));
  CHECK(before.safe == safe_word::unsafe);
  CHECK(before.streams.size() == 2);
  merge(before, parse_notification("ROSCELL_SAFE=1\n"
                                   "ROSCELL_STREAMS=input:0 3 2"));
  CHECK(before.safe == safe_word::safe);
  REQUIRE(before.streams.size() == 1);
  CHECK(before.streams[0].rate_hz == Approx(3));
}

TEST_CASE("merged notifications keep all values and the last status") {
  auto before = parse_notification("READY=1\nSTATUS=old");
  merge(before, parse_notification("WATCHDOG=1"));
  CHECK((before.ready && before.alive));
  CHECK(before.status == "old");
  merge(before, parse_notification("STOPPING=1\nSTATUS=new"));
  CHECK((before.ready && before.stopping));
  CHECK(before.status == "new");
}

TEST_CASE("a program says by its number which change of parameters it takes") {
  CHECK(parse_notification("ROSCELL_PARAMETERS_TAKEN=7").parameters_taken == 7);
  const auto refused =
      parse_notification("ROSCELL_PARAMETERS_REFUSED=8 too\tloud, by far");
  CHECK(refused.parameters_refused == 8);
  CHECK(refused.refusal == "too loud, by far");
  CHECK(parse_notification("ROSCELL_PARAMETERS_REFUSED=9").parameters_refused
        == 9);
  const auto longest = parse_notification("ROSCELL_PARAMETERS_REFUSED=9 "
                                          + std::string(3000, 'x'));
  CHECK(longest.refusal.size() == max_refusal_bytes);
}

TEST_CASE("an answer without a number that can be is none") {
  for (const std::string text :
       {"", "0", "-1", "x", "1x", " 1", "9007199254740992", "1.5"}) {
    CHECK(
        parse_notification("ROSCELL_PARAMETERS_TAKEN=" + text).parameters_taken
        == 0);
    const auto refused =
        parse_notification("ROSCELL_PARAMETERS_REFUSED=" + text + " why");
    CHECK((refused.parameters_refused == 0) == refused.refusal.empty());
  }
}

TEST_CASE("merged notifications keep the answers to the newest changes") {
  auto before = parse_notification("ROSCELL_PARAMETERS_TAKEN=5\n"
                                   "ROSCELL_PARAMETERS_REFUSED=6 why");
  merge(before, parse_notification("WATCHDOG=1"));
  CHECK(before.parameters_taken == 5);
  CHECK(before.parameters_refused == 6);
  merge(before, parse_notification("ROSCELL_PARAMETERS_TAKEN=7"));
  CHECK(before.parameters_taken == 7);
  CHECK(before.refusal == "why");
  merge(before, parse_notification("ROSCELL_PARAMETERS_REFUSED=8 other"));
  CHECK(before.refusal == "other");
}

TEST_CASE("a program asks for parameters under a number, one at a time") {
  auto asked =
      parse_notification("ROSCELL_PARAMETERS_WANTED=7 {\"word\":\"a b\"}");
  CHECK(asked.parameters_wanted == 7);
  CHECK(asked.wanted_parameters == R"({"word":"a b"})");
  for (const std::string text : {"", " {}", "0 {}", "x {}", "-1 {}"}) {
    const auto none = parse_notification("ROSCELL_PARAMETERS_WANTED=" + text);
    CHECK(none.parameters_wanted == 0);
    CHECK(none.wanted_parameters.empty());
  }
  merge(asked, parse_notification("WATCHDOG=1"));
  CHECK(asked.parameters_wanted == 7);
  merge(asked, parse_notification("ROSCELL_PARAMETERS_WANTED=8 {}"));
  CHECK(asked.parameters_wanted == 8);
  CHECK(asked.wanted_parameters == "{}");
}
