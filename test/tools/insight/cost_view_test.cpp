#include "tools/roscell/insight/insight_views.hpp"

#include "test/printed_text.hpp"

#include <catch2/catch.hpp>

namespace roscell::cli {

using test::cells_in;

namespace {

constexpr double mib = 1024 * 1024;

node_cost busy_node() {
  return {"base",
          {{"minute",
            75,
            0.15,
            8.1 * mib,
            750,
            {{"arm", 1440, 1417.5}, {"leg", 75, 0}}},
           {"day", 90'000, 90, 8 * mib, 0, {}}},
          ""};
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("Each window of a node's cost is a row of rates", "[tools]") {
  const auto text = cost_view({{busy_node()}}, {});
  CHECK(cells_in(text)
        == "NODE|WINDOW|SPAN|CPU (%)|PSS|WRITTEN A DAY|SENT (B/s)|"
           "RECEIVED (B/s)|PEERS (B/s)\n"
           "base|minute|1m15s|0.2|8.1 MiB|844 KiB|20.2|"
           "18.9|arm 19.2/18.9, leg 1/0\n"
           "base|day|1d01h|0.1|8 MiB|0 B|0|0|-\n");
  CHECK(test::right_aligned(text)
        == "SPAN|CPU (%)|PSS|WRITTEN A DAY|SENT (B/s)|RECEIVED (B/s)");
}

TEST_CASE("Before any time has passed there is no rate", "[tools]") {
  const auto text =
      cost_view({{{"base", {{"minute", 0, 0, mib, 0, {}}}, ""}}}, {});
  CHECK(mentions(cells_in(text), "base|minute|0s|0|1 MiB|"));
}

TEST_CASE("What a node writes at its start is not told as that of a day",
          "[tools]") {
  const auto text = [](double span_s) {
    return cost_view({{{"base", {{"minute", span_s, 0, mib, 60, {}}}, ""}}},
                     {});
  };
  CHECK_FALSE(mentions(text(59), " KiB "));
  CHECK(mentions(text(60), " KiB "));
}

TEST_CASE("Why a node's cost is not known is told below the others",
          "[tools]") {
  const auto text =
      cost_view({{busy_node(), {"leg", {}, "node 'leg' is\naway"}}}, {});
  CHECK(mentions(text, "\n\nleg: node 'leg' is?away\n"));
}

} // namespace roscell::cli
