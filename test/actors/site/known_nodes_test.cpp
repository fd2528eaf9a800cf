#include "actors/site/known_nodes.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

TEST_CASE("what a known node is called belongs to it") {
  known_nodes known;
  using claim = known_nodes::claim;
  CHECK(known.judge("arm", "0a") == claim::free);
  known.add("arm", "0a");
  CHECK(known.judge("arm", "0a") == claim::by_name);
  // Set up anew, it has another UUID.
  CHECK(known.judge("arm", "0b") == claim::by_name);
  CHECK(known.judge("belt", "0a") == claim::taken);
  CHECK(known.judge("belt", "0b") == claim::free);
}

TEST_CASE("known nodes are bounded") {
  known_nodes known;
  for (size_t i = 0; i < known_nodes::most + 1; ++i)
    known.add("node", std::to_string(i));
  CHECK(known.judge("x", std::to_string(known_nodes::most - 1))
        == known_nodes::claim::taken);
  CHECK(known.judge("x", std::to_string(known_nodes::most))
        == known_nodes::claim::free);
}
