#include "actors/membership/join_report.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

using namespace std::chrono_literals;

const join_report::time_point start{100s};

} // namespace

TEST_CASE("attempts are counted from the last time in a cell") {
  join_report report;
  CHECK(report.rows().empty());
  report.begin("10.0.0.1:11811", 1000);
  report.begin("10.0.0.1:11811", 7000);
  REQUIRE(report.rows().size() == 1);
  CHECK(report.rows()[0].attempts == 2);
  CHECK(report.rows()[0].tried_unix_ms == 7000);
  report.clear();
  CHECK(report.rows().empty());
  report.begin("10.0.0.1:11811", 9000);
  CHECK(report.rows()[0].attempts == 1);
}

TEST_CASE("the same problem is told again after ever longer pauses") {
  join_report report;
  report.begin("10.0.0.1:11811", 0);
  int reported = 0;
  for (auto passed = 0s; passed < 24h; passed += 30s)
    reported +=
        report.note("nothing listens there", "", start + passed) ? 1 : 0;
  // After 1, 2, 4, ... minutes, then every half an hour.
  CHECK(reported >= 48);
  CHECK(reported <= 54);
}

TEST_CASE("another problem is told at once, but not ever new ones") {
  join_report report;
  report.begin("10.0.0.1:11811", 0);
  CHECK(report.note("nothing listens there", "", start));
  CHECK(report.note("a firewall drops UDP", "open it", start + 1s));
  CHECK(report.rows()[0].problem == "a firewall drops UDP");
  CHECK(report.rows()[0].hint == "open it");
  CHECK_FALSE(report.note("nothing listens there", "", start + 2s));
  int reported = 0;
  for (int i = 0; i < 100; ++i)
    reported +=
        report.note("trouble " + std::to_string(i), "", start + 3s) ? 1 : 0;
  CHECK(reported < 10);
  CHECK(report.rows()[0].problem == "trouble 99");
}

TEST_CASE("problem at one address is not shown of another") {
  join_report report;
  report.begin("10.0.0.1:11811", 0);
  report.note("nothing listens there", "start it", start);
  report.begin("10.0.0.2:11811", 0);
  CHECK(report.rows()[0].address == "10.0.0.2:11811");
  CHECK(report.rows()[0].problem.empty());
  CHECK(report.rows()[0].hint.empty());
}

TEST_CASE("nothing is told of who does not try") {
  join_report report;
  CHECK_FALSE(report.note("nothing listens there", "", start));
}
