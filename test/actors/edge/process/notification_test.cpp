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
  const auto broken = parse_notification("STATUS=" + std::string(300, '\xFF'));
  CHECK(broken.status.size() == max_status_bytes / 3 * 3);
}

TEST_CASE("a notification longer than a datagram may be is ignored whole") {
  const std::string text = "READY=1\n";
  CHECK_FALSE(
      parse_notification(text + std::string(max_notification_bytes, 'x'))
          .ready);
}

TEST_CASE("merged notifications keep all facts and the last status") {
  notification before{true, false, false, "old"};
  merge(before, {false, true, false, ""});
  CHECK((before.ready && before.alive));
  CHECK(before.status == "old");
  merge(before, {false, false, true, "new"});
  CHECK((before.ready && before.stopping));
  CHECK(before.status == "new");
}
