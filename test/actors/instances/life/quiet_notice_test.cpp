#include "actors/instances/life/quiet_notice.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

const quiet_notice::time_point notice_zero{1000s};

struct notice_bench {
  notice_bench() {
    row.spec.input = {{"ros2", "/a", "std_msgs/msg/String"}};
    row.metrics.streams.resize(1);
    row.metrics.streams[0].end = "input:0";
  }

  bool hear(double quiet_s, std::chrono::seconds when) {
    row.metrics.streams[0].quiet_s = quiet_s;
    return notice.hear(row, notice_zero + when);
  }

  instance_row row;
  quiet_notice notice;
};

} // namespace

TEST_CASE("a silence is told once, and its end") {
  notice_bench b;
  CHECK_FALSE(b.hear(0, 0s));
  CHECK_FALSE(b.hear(28, 28s));
  CHECK(b.hear(32, 32s));
  CHECK_FALSE(b.hear(36, 36s));
  CHECK(b.hear(0, 40s));
  CHECK_FALSE(b.hear(0, 44s));
}

TEST_CASE("a stream that is often silent is told of seldom") {
  notice_bench b;
  int reported = 0;
  for (auto when = 0s; when < 24h; when += 40s) {
    reported += b.hear(35, when) ? 1 : 0;
    reported += b.hear(0, when + 5s) ? 1 : 0;
  }
  CHECK(reported == 2 * 24);
}

TEST_CASE("the silence of what is no topic, or is not counted, is not told") {
  notice_bench b;
  SECTION("a file") {
    b.row.spec.input[0].protocol = "file";
  }
  SECTION("an output") {
    b.row.metrics.streams[0].end = "output:0";
  }
  CHECK_FALSE(b.hear(60, 60s));
}
