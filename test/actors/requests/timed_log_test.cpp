#include "actors/requests/rest_streams.hpp"

#include "schemas/utf8.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

log_excerpt excerpt(const std::string& text, std::vector<int64_t> times) {
  log_excerpt result;
  result.text = text;
  result.times_unix_ms = std::move(times);
  return result;
}

} // namespace

TEST_CASE("Each line of a log stands behind its time", "[timed_log]") {
  timed_log log;
  CHECK(log.add(excerpt("one\ntwo\n", {1000, 2000}))
        == "1970-01-01T00:00:01.000Z one\n1970-01-01T00:00:02.000Z two\n");
}

TEST_CASE("A line that comes in two parts has one time", "[timed_log]") {
  timed_log log;
  CHECK(log.add(excerpt("on", {1000})) == "1970-01-01T00:00:01.000Z on");
  CHECK(log.add(excerpt("e\ntwo\n", {1500, 2000}))
        == "e\n1970-01-01T00:00:02.000Z two\n");
}

TEST_CASE("A log is shown byte by byte", "[timed_log]") {
  timed_log log;
  auto part = excerpt("a\xEF\xBF\xBD\n\xEF\xBF\xBD\n", {1000, 2000});
  part.bytes = to_base64("a\xff\n\xe9\n");
  CHECK(log.add(part)
        == "1970-01-01T00:00:01.000Z a\xff\n1970-01-01T00:00:02.000Z \xe9\n");
  part.times_unix_ms.clear();
  CHECK(log.add(part) == "a\xff\n\xe9\n");
}

TEST_CASE("A line whose time is not known has a dash", "[timed_log]") {
  timed_log log;
  CHECK(log.add(excerpt("one\n", {0})) == "- one\n");
  CHECK(log.add(excerpt("two\n", {})) == "two\n");
}

} // namespace roscell::test
