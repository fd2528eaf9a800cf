#include "tools/roscell/split_words.hpp"

#include <catch2/catch.hpp>

using namespace roscell::cli;

namespace {

using words = std::vector<std::string>;

} // namespace

TEST_CASE("blanks separate words", "[shell]") {
  CHECK(split_words("").words.empty());
  CHECK(split_words("  \t ").words.empty());
  CHECK(split_words(" tasks  --watch\t").words == words{"tasks", "--watch"});
}

TEST_CASE("quotes and the backslash keep blanks", "[shell]") {
  CHECK(split_words("a 'b c' \"d e\"f g\\ h").words
        == words{"a", "b c", "d ef", "g h"});
  CHECK(split_words("'a\"b' \"c'd\"").words == words{"a\"b", "c'd"});
  CHECK(split_words("'a\\' b").words == words{"a\\", "b"});
  CHECK(split_words(R"("a\"b\\c\d")").words == words{R"(a"b\c\d)"});
  CHECK(split_words("x '' \"\"").words == words{"x", "", ""});
}

TEST_CASE("nothing is expanded", "[shell]") {
  CHECK(split_words("$HOME * ~ `x`").words == words{"$HOME", "*", "~", "`x`"});
}

TEST_CASE("what is still open is told", "[shell]") {
  CHECK(split_words("a 'b").open == '\'');
  CHECK(split_words("a \"b\\").open == '\\');
  CHECK(split_words("a \"b\\\" c").open == '"');
  CHECK(split_words("a\\").open == '\\');
  CHECK(split_words("a 'b'").open == '\0');
}

TEST_CASE("the word that a line ends in is known by its place", "[shell]") {
  CHECK(split_words("logs hel").last_begin == 5);
  CHECK(split_words("logs hel").in_word);
  CHECK(split_words("logs ").last_begin == 5);
  CHECK_FALSE(split_words("logs ").in_word);
  CHECK(split_words("logs 'a b").last_begin == 5);
  CHECK(split_words("logs '").in_word);
}

TEST_CASE("a quoted word is split into itself", "[shell]") {
  for (const std::string word : {"plain", "a b", "it's", "", "a\"b\\c", "$x;#"})
    CHECK(split_words(shell_word(word)).words == words{word});
  CHECK(shell_word("--to=/a/b.c:1") == "--to=/a/b.c:1");
}

TEST_CASE("a line may begin with the name of the program", "[shell]") {
  CHECK(without_program({"roscell", "exit"}) == words{"exit"});
  CHECK(without_program({"roscell"}).empty());
  CHECK(without_program({"logs", "roscell"}) == words{"logs", "roscell"});
  CHECK(without_program({}).empty());
}
