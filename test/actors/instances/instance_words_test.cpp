#include "actors/instances/instance_words.hpp"

#include "messages/codec/json_codec.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

TEST_CASE("an exit code is told as people know it") {
  CHECK(exit_words(0) == "with exit code 0");
  CHECK(exit_words(127) == "with exit code 127");
  CHECK(exit_words(128) == "with exit code 128");
  CHECK(exit_words(139) == "by signal 11");
  CHECK(exit_words(-1) == "in an unknown way");
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
