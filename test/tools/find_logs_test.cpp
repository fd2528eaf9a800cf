#include "tools/roscell/client/find_things.hpp"

#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/log_lines.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

namespace {

kept_log log_of(const std::string& task, const std::string& step,
                const std::string& digits, int64_t ended_unix_ms) {
  kept_log result;
  result.task = task;
  result.step = step;
  result.instance = task + "-" + step + "-" + digits;
  result.node = "belt";
  result.ended_unix_ms = ended_unix_ms;
  return result;
}

/// The newest first, as a node tells them.
const std::vector<kept_log> kept{log_of("fleet", "poses", "5a2b3c4d", 5000),
                                 log_of("fleet", "camera", "4a2b3c4d", 4000),
                                 log_of("fleet", "camera", "4a2b3c4d", 3000),
                                 log_of("fleet", "poses", "1a2b3c4d", 1000),
                                 log_of("arm", "s", "2a2b3c4d", 900)};

std::vector<std::string> found_logs(const std::string& word) {
  std::vector<std::string> result;
  for (const auto& x : find_kept_logs(kept, word))
    result.push_back(x.instance + " " + std::to_string(x.ended_unix_ms));
  return result;
}

using words = std::vector<std::string>;

} // namespace

TEST_CASE("of a task that is gone the newest log of each step is meant",
          "[tools]") {
  CHECK(found_logs("fleet")
        == words{"fleet-camera-4a2b3c4d 4000", "fleet-poses-5a2b3c4d 5000"});
}

TEST_CASE("of an instance that is gone the newest log is meant", "[tools]") {
  CHECK(found_logs("fleet-camera-4a2b3c4d")
        == words{"fleet-camera-4a2b3c4d 4000"});
  CHECK(found_logs("fleet-poses-1a2b3c4d")
        == words{"fleet-poses-1a2b3c4d 1000"});
  CHECK(found_logs("fleet-c") == words{"fleet-camera-4a2b3c4d 4000"});
  CHECK(found_logs("none").empty());
  CHECK(found_logs("").empty());
  try {
    found_logs("fleet-p");
    FAIL("not refused");
  } catch (const command_error& e) {
    CHECK(e.code == exit_usage);
    CHECK(e.hint.find("fleet-poses-1a2b3c4d") != std::string::npos);
  }
}

TEST_CASE("a kept log is told with when and how its instance ended",
          "[tools]") {
  auto log = log_of("fleet", "poses", "5a2b3c4d", 5000);
  log.state = instance_state::failed;
  log.exit_code = 3;
  log.reason = "it ended with exit code 3";
  CHECK(kept_log_text(log, 65'000)
        == "fleet-poses-5a2b3c4d on node belt: failed 1m00s ago, exit code 3 "
           "(it ended with exit code 3)");
}

TEST_CASE("the list of kept logs tells what is missing", "[tools]") {
  view_style style;
  style.now_unix_ms = 65'000;
  auto log = log_of("fleet", "poses", "5a2b3c4d", 5000);
  log.reason = "removed";
  log.bytes = 2048;
  const auto text = kept_logs_view({{log}, 2, {"arm", "lift"}}, style);
  CHECK(text.find("fleet-poses-5a2b3c4d") != std::string::npos);
  CHECK(text.find("stopped: removed") != std::string::npos);
  CHECK(text.find("2 KiB") != std::string::npos);
  CHECK(text.find("2 more cannot be read\n") != std::string::npos);
  CHECK(text.find("without those of arm, lift") != std::string::npos);
  CHECK(kept_logs_view({}, style) == "no logs of instances that are gone\n");
}
