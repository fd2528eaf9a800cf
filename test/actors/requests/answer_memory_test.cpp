#include "actors/requests/answer_memory.hpp"
#include "actors/requests/limits.hpp"

#include <catch2/catch.hpp>

#include <string>

namespace roscell::test {

namespace {

using status = answer_memory::status;

std::string name(size_t i) {
  return "r" + std::to_string(i);
}

} // namespace

TEST_CASE("A request is worked on once, and then has its answer",
          "[answer_memory]") {
  answer_memory table;
  CHECK(table.look("a", "body") == status::unknown);
  table.begin("a", "body");
  CHECK(table.look("a", "body") == status::begun);
  CHECK(table.look("a", "other") == status::taken);
  table.finish("a", "done");
  CHECK(table.look("a", "body") == status::answered);
  CHECK(table.answer("a") == "done");
  CHECK(table.look("a", "other") == status::taken);
}

TEST_CASE("A refused request may be tried again, also with another body",
          "[answer_memory]") {
  answer_memory table;
  table.begin("a", "body");
  table.forget("a");
  CHECK(table.look("a", "other") == status::unknown);
  // Whoever is late changes nothing.
  table.finish("a", "done");
  table.forget("a");
  CHECK(table.size() == 0);
}

TEST_CASE("The oldest answers go, and no request that is worked on",
          "[answer_memory]") {
  answer_memory table;
  table.begin("long", "body");
  for (size_t i = 0; i <= limits::request::remembered; ++i) {
    table.begin(name(i), "body");
    table.finish(name(i), "done");
  }
  CHECK(table.size() == limits::request::remembered);
  CHECK(table.look("long", "body") == status::begun);
  CHECK(table.look(name(0), "body") == status::unknown);
  CHECK(table.look(name(1), "body") == status::unknown);
  CHECK(table.look(name(2), "body") == status::answered);
}

TEST_CASE("Large answers drive out others before they are many",
          "[answer_memory]") {
  answer_memory table;
  const std::string large(limits::request::remembered_bytes / 2, 'x');
  for (size_t i = 0; i < 3; ++i) {
    table.begin(name(i), "body");
    table.finish(name(i), large);
  }
  CHECK(table.size() == 1);
  CHECK(table.look(name(2), "body") == status::answered);
}

} // namespace roscell::test
