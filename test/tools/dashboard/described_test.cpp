#include "client/columns.hpp"
#include "tools/roscell/dashboard/pages.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

namespace {

/// What the script exports under a name.
json exported(const std::string& name) {
  const auto& script = described_script();
  const auto head = "export const " + name + " = ";
  const auto begin = script.find(head) + head.size();
  return json::parse(script.substr(begin, script.find(";\n", begin) - begin));
}

} // namespace

TEST_CASE("the dashboard is told which columns there are", "[dashboard]") {
  CHECK(exported("COLUMNS") == described_columns());
}

TEST_CASE("the dashboard is told which answers an event makes old",
          "[dashboard]") {
  const auto stale = exported("STALE");
  CHECK(stale.at(0) == json{"node_joined", {"cell", "cells", "skills"}});
}
