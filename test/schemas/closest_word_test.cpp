#include "schemas/closest_word.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

TEST_CASE("a slip of the pen finds the word that was meant") {
  std::vector<std::string_view> words{"task_query", "task_request",
                                      "cell_list"};
  CHECK(closest_word("task_reqest", words) == "task_request");
  CHECK(closest_word("tsak_query", words) == "task_query");
  CHECK(closest_word("TASK_QUERY", words).empty());
  CHECK(closest_word("cell-list", words) == "cell_list");
}

TEST_CASE("a word that is near none finds none") {
  std::vector<std::string_view> words{"task_query", "log"};
  CHECK(closest_word("dance", words).empty());
  CHECK(closest_word("", words).empty());
  CHECK(closest_word(std::string(1'000'000, 't'), words).empty());
  CHECK(closest_word("log", {}).empty());
}
