#include "schemas/decode.hpp"

#include "messages/task.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

TEST_CASE("a message is decoded to its struct") {
  auto result = decode<task_query>({{"type", "task_query"}, {"task", "a"}});
  REQUIRE(std::holds_alternative<task_query>(result));
  CHECK(std::get<task_query>(result).task == "a");
}

TEST_CASE("a part of a message needs no type") {
  auto result = decode<io_endpoint>(
      {{"protocol", "file"}, {"endpoint", "/a"}, {"data_type", "x"}});
  CHECK(std::holds_alternative<io_endpoint>(result));
}

TEST_CASE("a message of another type is refused") {
  auto result = decode<task_query>({{"type", "task_request"}});
  REQUIRE(std::holds_alternative<failure>(result));
  CHECK(std::get<failure>(result).code == error_code::unknown_type);
}

TEST_CASE("what the struct cannot hold is a refusal, not an exception") {
  for (const json& document :
       {json{{"type", "task_termination"}}, json(7), json(nullptr),
        json{{"type", "task_termination"}, {"task", 7}}}) {
    auto result = decode<task_termination>(document);
    REQUIRE(std::holds_alternative<failure>(result));
    CHECK(std::get<failure>(result).code == error_code::schema_violation);
  }
}

TEST_CASE("an unknown word of an enumeration is a refusal") {
  auto result = decode<task_row>({{"task", "a"},
                                  {"state", "asleep"},
                                  {"submitted_unix_ms", 0},
                                  {"instances", json::array()}});
  CHECK(std::holds_alternative<failure>(result));
}
