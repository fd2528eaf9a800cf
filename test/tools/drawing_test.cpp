#include "tools/roscell/view/graph/graph_view.hpp"

#include "test/printed_text.hpp"

#include <catch2/catch.hpp>

using namespace roscell::cli;
using roscell::test::widest_line;

TEST_CASE("a lane leads from where something goes out to all that read it",
          "[tools]") {
  CHECK(
      drawing({{{"camera"}, {"out /image", "i"}, {"out /info", "n"}},
               {{"poses"}, {"in /image", "i", true}},
               {{"record"}, {"in /image", "i", true}, {"in /info", "n", true}}},
              80)
      == "    ┌────────────┐\n"
         "    │ camera     │\n"
         "┌───│ out /image │\n"
         "│ ┌─│ out /info  │\n"
         "│ │ └────────────┘\n"
         "│ │ ┌───────────┐\n"
         "│ │ │ poses     │\n"
         "├─│▶│ in /image │\n"
         "│ │ └───────────┘\n"
         "│ │ ┌───────────┐\n"
         "│ │ │ record    │\n"
         "└─│▶│ in /image │\n"
         "  └▶│ in /info  │\n"
         "    └───────────┘\n");
}

TEST_CASE("what leads back has a lane, too, and what leads out has none",
          "[tools]") {
  CHECK(drawing({{{"in /b", "b", true}, {"out /a", "a"}},
                 {{"in /a", "a", true}, {"out /b", "b"}, {"out /c", "c"}}},
                80)
        == "    ┌────────┐\n"
           "┌──▶│ in /b  │\n"
           "│ ┌─│ out /a │\n"
           "│ │ └────────┘\n"
           "│ │ ┌────────┐\n"
           "│ └▶│ in /a  │\n"
           "└───│ out /b │\n"
           "    │ out /c │\n"
           "    └────────┘\n");
}

TEST_CASE("no line of a drawing is wider than the terminal", "[tools]") {
  std::vector<std::vector<drawn_line>> boxes;
  for (int i = 0; i < 12; ++i)
    boxes.push_back({{"a step with a very long name that does not fit"},
                     {"in", std::to_string(i), true},
                     {"out", std::to_string((i * 5 + 1) % 12)}});
  for (size_t width = 1; width < 120; ++width)
    CHECK(widest_line(drawing(boxes, width)) <= width);
}

TEST_CASE("lanes that are not beside each other share a column", "[tools]") {
  std::vector<std::vector<drawn_line>> boxes;
  for (int i = 0; i < 20; ++i)
    boxes.push_back(
        {{"in", std::to_string(i), true}, {"out", std::to_string(i + 1)}});
  CHECK(widest_line(drawing(boxes, 80)) == 9);
}
