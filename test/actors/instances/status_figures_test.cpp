#include "actors/instances/status_figures.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

using namespace std::chrono_literals;

TEST_CASE("The figures of a status are found among its words",
          "[status_figures]") {
  const auto x =
      figures_in("frames=120 dropped=3 failed=1 median_us=850 p99_us=2000");
  CHECK(x.frames == 120);
  CHECK(x.dropped == 3);
  CHECK(x.latency_ms == Approx(0.85));
  CHECK(x.rate_hz == -1);
}

TEST_CASE("What is no figure of a status is passed over", "[status_figures]") {
  for (const auto* text :
       {"", " ", "12 frames/s", "frames=", "frames=-1", "frames=1.5",
        "frames=x", "=12", "frames=99999999999999999999",
        "frames=9007199254740992", "xframes=3"})
    CHECK(figures_in(text) == instance_figures{});
  CHECK(figures_in("waiting  frames=7").frames == 7);
}

TEST_CASE("A median of no frames is none", "[status_figures]") {
  CHECK(figures_in("frames=0 median_us=0").latency_ms == -1);
  CHECK(figures_in("frames=1 median_us=0").latency_ms == 0);
}

TEST_CASE("The rate is that between the last two words", "[status_figures]") {
  figures_book book;
  book.hear("frames=10", time_zero);
  CHECK(book.known().rate_hz == -1);
  book.hear("frames=30", time_zero + 2s);
  CHECK(book.known().rate_hz == Approx(10));
  book.hear("frames=30", time_zero + 4s);
  CHECK(book.known().rate_hz == 0);
}

TEST_CASE("A word that follows at once makes no rate of its own",
          "[status_figures]") {
  figures_book book;
  book.hear("frames=10", time_zero);
  book.hear("frames=20", time_zero + 1s);
  book.hear("frames=25", time_zero + 1010ms);
  CHECK(book.known().rate_hz == Approx(10));
  CHECK(book.known().frames == 25);
  book.hear("frames=40", time_zero + 3s);
  CHECK(book.known().rate_hz == Approx(10));
}

TEST_CASE("Figures stay within what a message may hold", "[status_figures]") {
  figures_book book;
  book.hear("frames=0", time_zero);
  book.hear("frames=9007199254740991 median_us=9007199254740991",
            time_zero + 1s);
  CHECK(book.known().rate_hz == 1e9);
  CHECK(book.known().latency_ms == 1e9);
}

TEST_CASE("A program that begins anew has no rate at first",
          "[status_figures]") {
  figures_book book;
  book.hear("frames=10", time_zero);
  book.hear("frames=20", time_zero + 1s);
  book.hear("frames=3", time_zero + 2s);
  CHECK(book.known().rate_hz == -1);
  book.hear("starting", time_zero + 3s);
  CHECK(book.known() == instance_figures{});
}

} // namespace roscell::test
