#include "roscell/skill/errors.hpp"
#include "roscell/skill/typed_ports.hpp"

#include <catch2/catch.hpp>

using namespace roscell::engine;

namespace {

std::vector<stream> streams(const std::vector<std::string>& types) {
  std::vector<stream> result;
  for (const auto& type : types)
    result.push_back({"file", "/out", type});
  return result;
}

} // namespace

TEST_CASE("the k-th source has the k-th output of each type") {
  auto outputs = streams({"a", "b", "a", "b"});
  typed_outputs a{outputs, "a", 2};
  typed_outputs b{outputs, "b", 2};
  CHECK(a.of_source(0) == 0);
  CHECK(a.of_source(1) == 2);
  CHECK(b.of_source(0) == 1);
  CHECK(b.of_source(1) == 3);
}

TEST_CASE("all sources share the only output of a type") {
  typed_outputs a{streams({"b", "a"}), "a", 3};
  CHECK(a.of_source(0) == 1);
  CHECK(a.of_source(2) == 1);
}

TEST_CASE("a type without outputs has none for any source") {
  typed_outputs a{streams({"b"}), "a", 3};
  CHECK(a.of_source(2) == typed_outputs::none);
}

TEST_CASE("outputs that cannot be given to the sources are refused") {
  CHECK_THROWS_AS((typed_outputs{streams({"a", "a"}), "a", 3}), start_error);
  CHECK_THROWS_AS((typed_outputs{streams({"a", "a"}), "a", 1}), start_error);
}
