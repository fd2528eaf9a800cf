#include "messages/instance.hpp"
#include "skills/engine/file/line_input.hpp"
#include "skills/engine/life/heartbeat.hpp"
#include "skills/engine/life/processing_times.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>

using namespace roscell::engine;
using namespace std::chrono_literals;

TEST_CASE("processing times have a median and a 99th percentile") {
  processing_times times;
  CHECK(times.count() == 0);
  CHECK(times.quantile(0.5) == 0ns);
  for (auto i = 1; i <= 1000; ++i)
    times.add(std::chrono::microseconds{i});
  CHECK(times.count() == 1000);
  // A quantile is off by at most 1/32.
  CHECK(times.quantile(0.5) > 484us);
  CHECK(times.quantile(0.5) < 516us);
  CHECK(times.quantile(0.99) > 959us);
  CHECK(times.quantile(0.99) < 1021us);
  CHECK(times.quantile(1) > 968us);
}

TEST_CASE("a processing time of any length is counted") {
  processing_times times;
  times.add(-1ns);
  times.add(0ns);
  times.add(15ns);
  times.add(16ns);
  times.add(std::chrono::nanoseconds::max());
  CHECK(times.count() == 5);
  CHECK(times.quantile(0.2) == 0ns);
  CHECK(times.quantile(0.6) == 15ns);
  CHECK(times.quantile(0.8) == 16ns);
  CHECK(times.quantile(1) > std::chrono::hours{24 * 365 * 280});
}

TEST_CASE("a rare slow call shows in the percentile, not in the median") {
  processing_times times;
  for (auto i = 0; i < 98; ++i)
    times.add(10us);
  times.add(1s);
  times.add(1s);
  CHECK(times.quantile(0.5) < 11us);
  CHECK(times.quantile(0.99) > 900ms);
}

TEST_CASE("a skill counts its frames by the bounds that a node knows") {
  const auto& own = processing_times::bounds_ms;
  CHECK(std::equal(own.begin(), own.end(), roscell::latency_bounds_ms.begin(),
                   roscell::latency_bounds_ms.end(), [](auto a, double b) {
                     return static_cast<double>(a) == b;
                   }));
}

TEST_CASE("a time that is as long as a bound lies within it") {
  processing_times times;
  for (const auto time : {0us, 1000us, 1001us, 2000us, 1'000'000us})
    times.add(time);
  times.add(1s + 1ns);
  const auto all = times.tallied();
  CHECK(all.count == 6);
  CHECK(all.sum_ns == 2'004'001'001);
  CHECK(all.counts == decltype(all.counts){2, 2, 0, 0, 0, 0, 0, 0, 0, 1, 1});
}

TEST_CASE("what a status says of frames is one line of metrics") {
  processing_times times;
  CHECK(frame_text(times, 0, 0)
        == "frames=0 dropped=0 failed=0 median_us=0 p99_us=0 times_us=0 "
           "times=0,0,0,0,0,0,0,0,0,0,0");
  times.add(15ns);
  times.add(3ms);
  const auto words = frame_text(times, 7, 1);
  CHECK(words.find("frames=2 dropped=7 failed=1 median_us=0 p99_us=") == 0);
  CHECK(words.find(" times_us=3000 times=1,0,1,0,0,0,0,0,0,0,0")
        != std::string::npos);
}

TEST_CASE("a skill that waits for frames is alive") {
  liveness alive{2s};
  liveness::clock::time_point start{};
  CHECK(alive.allows_heartbeat(start + 100h));
}

TEST_CASE("a skill is alive while its work takes less than half a period") {
  liveness alive{2s};
  liveness::clock::time_point start{};
  alive.work_begins(start);
  CHECK(alive.allows_heartbeat(start + 999ms));
  CHECK_FALSE(alive.work_ends());
  alive.work_begins(start + 5s);
  CHECK(alive.allows_heartbeat(start + 5900ms));
}

TEST_CASE("a heartbeat that was withheld is owed when the work ends") {
  liveness alive{2s};
  liveness::clock::time_point start{};
  alive.work_begins(start);
  CHECK_FALSE(alive.allows_heartbeat(start + 1s));
  CHECK_FALSE(alive.allows_heartbeat(start + 100s));
  CHECK(alive.work_ends());
  CHECK(alive.allows_heartbeat(start + 101s));
  alive.work_begins(start + 102s);
  CHECK_FALSE(alive.work_ends());
}

TEST_CASE("lines are cut wherever the chunks end") {
  line_splitter lines{100};
  lines.feed("one\ntw");
  CHECK(lines.next() == "one");
  CHECK_FALSE(lines.next());
  CHECK(lines.has_rest());
  lines.feed("o\n\nfour");
  CHECK(lines.next() == "two");
  CHECK(lines.line_number() == 2);
  CHECK(lines.next() == "");
  CHECK_FALSE(lines.next());
  CHECK(lines.rest() == "four");
  CHECK(lines.line_number() == 4);
  CHECK_FALSE(lines.rest());
  CHECK_FALSE(lines.has_rest());
}

TEST_CASE("a line that is too long is left out, but counted") {
  line_splitter lines{3};
  lines.feed("abc\nabcd\nx\nabcd");
  CHECK(lines.next() == "abc");
  CHECK(lines.next() == "x");
  CHECK(lines.line_number() == 3);
  CHECK_FALSE(lines.next());
  for (auto i = 0; i < 1000; ++i) {
    lines.feed("more");
    CHECK_FALSE(lines.next());
  }
  lines.feed("\ny\n");
  CHECK(lines.next() == "y");
  CHECK(lines.line_number() == 5);
  CHECK(lines.too_long() == 2);
  lines.feed("toolong");
  CHECK_FALSE(lines.rest());
  CHECK(lines.too_long() == 3);
}
