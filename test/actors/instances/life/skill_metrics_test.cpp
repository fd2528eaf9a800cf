#include "actors/instances/life/skill_metrics.hpp"
#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

const stream_table::time_point word_zero{1000s};

struct stream_table_bench {
  stream_count hear(int64_t frames, std::chrono::milliseconds when) {
    std::vector<stream_count> reported(1);
    reported[0].end = "input:0";
    reported[0].frames = frames;
    table.hear(reported, word_zero + when);
    return reported[0];
  }

  stream_table table;
};

} // namespace

TEST_CASE("a stream's rate is that between the last two words") {
  stream_table_bench b;
  CHECK(b.hear(10, 0s).rate_hz < 0);
  CHECK(b.hear(30, 2s).rate_hz == Approx(10));
  CHECK(b.hear(31, 2100ms).rate_hz == Approx(10));
  CHECK(b.hear(30 + 40, 4s).rate_hz == Approx(20));
}

TEST_CASE("a stream is quiet since the word that told its last frame") {
  stream_table_bench b;
  CHECK(b.hear(0, 0s).quiet_s == 0);
  CHECK(b.hear(0, 4s).quiet_s == Approx(4));
  CHECK(b.hear(1, 8s).quiet_s == 0);
  CHECK(b.hear(1, 20s).quiet_s == Approx(12));
}

TEST_CASE("a stream is steady once it has had three frames in ten seconds") {
  stream_table_bench b;
  int64_t frames = 0;
  for (auto when = 0s; when < 10s; when += 2s)
    CHECK(b.hear(frames++, when).steady_s < 0);
  CHECK(b.hear(5, 10s).steady_s == 0);
  CHECK(b.hear(6, 12s).steady_s == Approx(2));
  SECTION("and until there are fewer") {
    CHECK(b.hear(6, 16s).steady_s == Approx(6));
    CHECK(b.hear(6, 20s).steady_s < 0);
  }
}

TEST_CASE("a frame now and then makes no steady stream") {
  stream_table_bench b;
  for (int i = 0; i < 20; ++i)
    CHECK(b.hear(i, 5s * i).steady_s < 0);
}

TEST_CASE("a stream of a program that begins anew has been neither quiet nor "
          "steady") {
  stream_table_bench b;
  for (int i = 0; i < 10; ++i)
    b.hear(100 * i, 2s * i);
  const auto anew = b.hear(3, 30s);
  CHECK(anew.rate_hz < 0);
  CHECK(anew.quiet_s == 0);
  CHECK(anew.steady_s < 0);
}

TEST_CASE("a stream that is not told of is forgotten") {
  stream_table_bench b;
  b.hear(0, 0s);
  std::vector<stream_count> none;
  b.table.hear(none, word_zero + 4s);
  CHECK(b.hear(0, 8s).quiet_s == 0);
}

namespace roscell::test {

TEST_CASE("The metrics of a status are found among its words",
          "[skill_metrics]") {
  const auto x =
      metrics_in("frames=120 dropped=3 failed=1 median_us=850 p99_us=2000");
  CHECK(x.frames == 120);
  CHECK(x.dropped == 3);
  CHECK(x.latency_ms == Approx(0.85));
  CHECK(x.rate_hz == -1);
}

TEST_CASE("What is no metric of a status is passed over", "[skill_metrics]") {
  for (const auto* text :
       {"", " ", "12 frames/s", "frames=", "frames=-1", "frames=1.5",
        "frames=x", "=12", "frames=99999999999999999999",
        "frames=9007199254740992", "xframes=3"})
    CHECK(metrics_in(text) == instance_metrics{});
  CHECK(metrics_in("waiting  frames=7").frames == 7);
}

TEST_CASE("How many frames took how long is found in a status",
          "[skill_metrics]") {
  const auto x = metrics_in(
      "frames=12 times_us=250500 times=1,2,0,4,0,0,3,0,0,1,1 age_us=9");
  CHECK(x.latency_counts
        == std::vector<int64_t>{1, 2, 0, 4, 0, 0, 3, 0, 0, 1, 1});
  CHECK(x.latency_sum_ms == Approx(250.5));
  CHECK(x.age_ms == Approx(0.009));
}

TEST_CASE("Times that are no histogram are passed over", "[skill_metrics]") {
  const std::string ten = "1,2,3,4,5,6,7,8,9,10";
  for (const auto& times : std::vector<std::string>{
           std::string{}, std::string{"1"}, std::string(10, ','),
           std::string(100'000, ','), ten, ten + ",", ten + ",11,",
           ten + ",11,12", "," + ten, ten + ",-1", ten + ",1.5", ten + ",x",
           ten + ",+1", ten + ",9007199254740992", "1,,2,3,4,5,6,7,8,9,10"}) {
    INFO(times.substr(0, 60));
    CHECK(metrics_in("times_us=5 times=" + times) == instance_metrics{});
  }
  const auto eleven = ten + ",11";
  CHECK(metrics_in("times=" + eleven) == instance_metrics{});
  CHECK(metrics_in("times_us=x times=" + eleven) == instance_metrics{});
  CHECK(metrics_in("times_us=5 times=" + eleven).latency_counts.size() == 11);
}

TEST_CASE("A median of no frames is none", "[skill_metrics]") {
  CHECK(metrics_in("frames=0 median_us=0").latency_ms == -1);
  CHECK(metrics_in("frames=1 median_us=0").latency_ms == 0);
}

TEST_CASE("The rate is that between the last two words", "[skill_metrics]") {
  skill_metrics_table table;
  table.hear("frames=10", time_zero);
  CHECK(table.known().rate_hz == -1);
  table.hear("frames=30", time_zero + 2s);
  CHECK(table.known().rate_hz == Approx(10));
  table.hear("frames=30", time_zero + 4s);
  CHECK(table.known().rate_hz == 0);
}

TEST_CASE("A word that follows at once makes no rate of its own",
          "[skill_metrics]") {
  skill_metrics_table table;
  table.hear("frames=10", time_zero);
  table.hear("frames=20", time_zero + 1s);
  table.hear("frames=25", time_zero + 1010ms);
  CHECK(table.known().rate_hz == Approx(10));
  CHECK(table.known().frames == 25);
  table.hear("frames=40", time_zero + 3s);
  CHECK(table.known().rate_hz == Approx(10));
}

TEST_CASE("Metrics stay within what a message may hold", "[skill_metrics]") {
  skill_metrics_table table;
  table.hear("frames=0", time_zero);
  const std::string most = "9007199254740991";
  auto times = " times_us=" + most + " times=" + most;
  for (int i = 0; i < 10; ++i)
    times += "," + most;
  table.hear("frames=" + most + " median_us=" + most + times, time_zero + 1s);
  CHECK(table.known().rate_hz == 1e9);
  CHECK(table.known().latency_ms == 1e9);
  CHECK(table.known().latency_counts
        == std::vector<int64_t>(11, 9'007'199'254'740'991));
  CHECK(table.known().latency_sum_ms == Approx(9'007'199'254'740.991));
}

TEST_CASE("A program that begins anew has no rate at first",
          "[skill_metrics]") {
  skill_metrics_table table;
  table.hear("frames=10", time_zero);
  table.hear("frames=20", time_zero + 1s);
  table.hear("frames=3", time_zero + 2s);
  CHECK(table.known().rate_hz == -1);
  table.hear("starting", time_zero + 3s);
  CHECK(table.known() == instance_metrics{});
}

TEST_CASE("What goes along with a status is known until the next one",
          "[skill_metrics]") {
  skill_metrics_table table;
  std::vector<stream_count> reported(1);
  reported[0].end = "input:0";
  reported[0].frames = 10;
  table.hear("frames=10", time_zero, reported, "none out");
  reported[0].frames = 30;
  table.hear("frames=10", time_zero + 4s, reported, "none out");
  REQUIRE(table.known().streams.size() == 1);
  CHECK(table.known().streams[0].rate_hz == Approx(5));
  CHECK(table.known().remark == "none out");
  table.hear("frames=12", time_zero + 8s);
  CHECK(table.known().streams.empty());
  CHECK(table.known().remark.empty());
}

TEST_CASE("A run's streams have not been quiet before it began",
          "[skill_metrics]") {
  skill_metrics_table table;
  std::vector<stream_count> reported(1);
  reported[0].end = "input:0";
  table.hear("frames=0", time_zero, reported);
  table.begin_run();
  table.hear("frames=0", time_zero + 30s, reported);
  CHECK(table.known().streams[0].quiet_s == 0);
}

} // namespace roscell::test

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
