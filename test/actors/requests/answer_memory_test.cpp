#include "actors/requests/answer_memory.hpp"

#include "actors/house/limits.hpp"

#include <catch2/catch.hpp>

#include <string>

namespace roscell::test {

namespace {

using standing = answer_memory::standing;

std::string name(size_t i) {
  return "r" + std::to_string(i);
}

} // namespace

TEST_CASE("A request is worked on once, and then has its answer",
          "[answer_memory]") {
  answer_memory book;
  CHECK(book.look("a", "body") == standing::unknown);
  book.begin("a", "body");
  CHECK(book.look("a", "body") == standing::begun);
  CHECK(book.look("a", "other") == standing::taken);
  book.finish("a", "done");
  CHECK(book.look("a", "body") == standing::answered);
  CHECK(book.answer("a") == "done");
  CHECK(book.look("a", "other") == standing::taken);
}

TEST_CASE("A refused request may be tried again, also with another body",
          "[answer_memory]") {
  answer_memory book;
  book.begin("a", "body");
  book.forget("a");
  CHECK(book.look("a", "other") == standing::unknown);
  // Whoever is late changes nothing.
  book.finish("a", "done");
  book.forget("a");
  CHECK(book.size() == 0);
}

TEST_CASE("The oldest answers go, and no request that is worked on",
          "[answer_memory]") {
  answer_memory book;
  book.begin("long", "body");
  for (size_t i = 0; i <= limits::request::remembered; ++i) {
    book.begin(name(i), "body");
    book.finish(name(i), "done");
  }
  CHECK(book.size() == limits::request::remembered);
  CHECK(book.look("long", "body") == standing::begun);
  CHECK(book.look(name(0), "body") == standing::unknown);
  CHECK(book.look(name(1), "body") == standing::unknown);
  CHECK(book.look(name(2), "body") == standing::answered);
}

TEST_CASE("Large answers drive out others before they are many",
          "[answer_memory]") {
  answer_memory book;
  const std::string large(limits::request::remembered_bytes / 2, 'x');
  for (size_t i = 0; i < 3; ++i) {
    book.begin(name(i), "body");
    book.finish(name(i), large);
  }
  CHECK(book.size() == 1);
  CHECK(book.look(name(2), "body") == standing::answered);
}

} // namespace roscell::test
