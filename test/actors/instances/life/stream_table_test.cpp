#include "actors/instances/life/stream_table.hpp"

#include <catch2/catch.hpp>

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
