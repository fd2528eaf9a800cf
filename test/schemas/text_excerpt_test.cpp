#include "schemas/text_excerpt.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

TEST_CASE("a quoted text is escaped as in JSON") {
  CHECK(in_quotes("a\"b\n") == R"("a\"b\n")");
}

TEST_CASE("a long text is cut between characters") {
  CHECK(in_quotes(u8"äöü", 2) == u8"\"äö\"...");
  CHECK(in_quotes(u8"äöü", 3) == u8"\"äöü\"");
}

TEST_CASE("bytes that are no UTF-8 are replaced") {
  CHECK_NOTHROW(json(in_quotes("a\xff")).dump());
  CHECK_NOTHROW(json(in_quotes("\x80\x80")).dump());
}

TEST_CASE("a member that is missing is named") {
  CHECK(absence_text("id", "a name")
        == R"(expected "id", a name, but it is missing)");
}

TEST_CASE("a value is told in few words") {
  CHECK(shown_value(nullptr) == "null");
  CHECK(shown_value(true) == "true");
  CHECK(shown_value(-7) == "the number -7");
  CHECK(shown_value(0.5) == "the number 0.5");
  CHECK(shown_value("a b") == R"("a b")");
  CHECK(shown_value(json::array()) == "an array of 0 items");
  CHECK(shown_value({{"a", 1}}) == "an object of 1 member");
  auto words = shown_value(std::string(80, 'x'));
  CHECK(words == '"' + std::string(40, 'x') + "\"... (80 characters)");
}

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
