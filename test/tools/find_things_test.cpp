#include "tools/roscell/client/find_things.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/log_lines.hpp"

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

using words = std::vector<std::string>;

} // namespace

TEST_CASE("a task means all of its instances", "[tools]") {
  CHECK(found("fleet")
        == words{"fleet-camera-1a2b3c4d", "fleet-poses-2a2b3c4d"});
  CHECK(found("fleet-2") == words{"fleet-2-poses-3a2b3c4d"});
}

TEST_CASE("the beginning of an id is enough if no other begins so", "[tools]") {
  CHECK(found("fleet-poses-2a2b3c4d") == words{"fleet-poses-2a2b3c4d"});
  CHECK(found("fleet-c") == words{"fleet-camera-1a2b3c4d"});
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

TEST_CASE("each line of a step's log stands behind its name", "[tools]") {
  log_lines lines{"poses | ", log_reader::program};
  CHECK(lines.add("one\ntwo\n") == "poses | one\nposes | two\n");
  CHECK(lines.add("thr") == "poses | thr");
  CHECK(lines.add("ee\n\n") == "ee\nposes | \n");
}

TEST_CASE("a log without a name is printed as it is", "[tools]") {
  log_lines lines{"", log_reader::program};
  CHECK(lines.add("a\x1b[2J\nb") == "a\x1b[2J\nb");
  CHECK(lines.finish().empty());
}

TEST_CASE("a log steers no terminal", "[tools]") {
  CHECK(harmless_line("a\x1b]52;c;eA==\x07z") == "a?]52;c;eA==?z");
  CHECK(harmless_line("\x1b[2Jx\ry") == "?[2Jx?y");
  CHECK(harmless_line("\x1b") == "?");
  CHECK(harmless_line("\xc2\x9b") == "??");
}

TEST_CASE("colours of a log are left out, its tabs and letters stay",
          "[tools]") {
  CHECK(harmless_line("\x1b[1;31mred\x1b[0m\t\tü\r") == "red\t\tü");
  CHECK(harmless_line("\x1b[m").empty());
}

TEST_CASE("a terminal gets whole lines, however they come", "[tools]") {
  log_lines lines{"poses | ", log_reader::terminal};
  CHECK(lines.add("ü \x1b[3").empty());
  CHECK(lines.add("2mgreen\ntwo\nthr\xc3") == "poses | ü green\nposes | two\n");
  CHECK(lines.add("\xbc").empty());
  CHECK(lines.finish() == "poses | thrü");
  CHECK(lines.finish().empty());
}
