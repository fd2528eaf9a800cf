#include "actors/instances/life/instance_text.hpp"

#include "messages/codec/json_codec.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

TEST_CASE("an exit code is told as people know it") {
  CHECK(exit_code_text(0) == "with exit code 0");
  CHECK(exit_code_text(127) == "with exit code 127");
  CHECK(exit_code_text(128) == "with exit code 128");
  CHECK(exit_code_text(139) == "by signal 11");
  CHECK(exit_code_text(-1) == "in an unknown way");
}

TEST_CASE("out of memory is told with what it may have and what it took") {
  instance_row row;
  row.exit_code = 137;
  row.spec.resources.memory_mib = 64;
  CHECK(end_reason_text(row, end_cause::usual, 64) == "it ended by signal 9");
  CHECK(end_reason_text(row, end_cause::memory, 63.9)
        == "out of memory: it may use 64 MiB, and took 64 MiB");
  CHECK(end_reason_text(row, end_cause::memory, -1)
        == "out of memory: it may use 64 MiB");
  CHECK(end_reason_text(row, end_cause::memory, 20)
        == "out of memory: its host had no more; it took 20 MiB, and may use "
           "64 MiB");
  row.spec.resources.memory_mib = 0;
  CHECK(end_reason_text(row, end_cause::memory, 20)
        == "out of memory: its host had no more; it took 20 MiB");
  CHECK(end_reason_text(row, end_cause::memory, -1)
        == "out of memory: its host had no more");
  row.exit_code = -1;
  CHECK(end_reason_text(row, end_cause::supervision, -1)
        == "its supervision was ended from outside, and its program with it");
}

TEST_CASE("the last bytes of a text begin with a whole line") {
  CHECK(last_bytes("short", 10) == "short");
  CHECK(last_bytes("first\nsecond\nthird\n", 10) == "third\n");
  CHECK(last_bytes("no newline at all", 6) == "at all");
  CHECK(last_bytes("ends in one line\n", 5) == "line\n");
  CHECK(last_bytes("", 0).empty());
}

TEST_CASE("a character that the bound cuts is replaced") {
  CHECK(last_bytes("a\xC3\xA4", 1) == "\xEF\xBF\xBD");
}

TEST_CASE("an unknown exit code is null in the details of a failure") {
  instance_row row;
  row.spec.instance = "i";
  row.node = "n";
  row.state = instance_state::failed;
  row.reason = "no such program";
  const auto why = deployment_failure(row);
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message == "instance 'i' on node 'n' failed: no such program");
  CHECK(json::parse(why.details).at("exit_code").is_null());
  CHECK(why.hint.empty());
}
