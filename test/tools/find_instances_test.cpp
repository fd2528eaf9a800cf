#include "tools/roscell/client/find_things.hpp"

#include "tools/roscell/exit_code.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

namespace {

instance_row row(const std::string& task, const std::string& step,
                 const std::string& digits) {
  instance_row result;
  result.spec.task = task;
  result.spec.step = step;
  result.spec.instance = task + "-" + step + "-" + digits;
  return result;
}

const std::vector<instance_row> known{row("fleet", "camera", "1a2b3c4d"),
                                      row("fleet", "poses", "2a2b3c4d"),
                                      row("fleet-2", "poses", "3a2b3c4d")};

std::vector<std::string> found(const std::string& word) {
  std::vector<std::string> result;
  for (const auto& x : find_instances(known, word))
    result.push_back(x.spec.instance);
  return result;
}

using names = std::vector<std::string>;

} // namespace

TEST_CASE("a task means all of its instances", "[tools]") {
  CHECK(found("fleet")
        == names{"fleet-camera-1a2b3c4d", "fleet-poses-2a2b3c4d"});
  CHECK(found("fleet-2") == names{"fleet-2-poses-3a2b3c4d"});
}

TEST_CASE("the beginning of an id is enough if no other begins so", "[tools]") {
  CHECK(found("fleet-poses-2a2b3c4d") == names{"fleet-poses-2a2b3c4d"});
  CHECK(found("fleet-c") == names{"fleet-camera-1a2b3c4d"});
  try {
    found("fleet-");
    FAIL("not refused");
  } catch (const command_error& e) {
    CHECK(e.code == exit_usage);
    CHECK(e.hint.find("fleet-2-poses-3a2b3c4d") != std::string::npos);
  }
}

TEST_CASE("for an unknown name the nearest one is told", "[tools]") {
  try {
    found("flett");
    FAIL("not refused");
  } catch (const command_error& e) {
    CHECK(e.code == exit_refused);
    CHECK(e.hint.find("did you mean 'fleet'?") == 0);
  }
  CHECK_THROWS_AS(found(""), command_error);
}
