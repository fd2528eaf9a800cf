#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/invitation.hpp"
#include "actors/edge/trust/invitation_table.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

using time_point = invitation_table::time_point;

const std::string secret(32, 'b');

invitation one() {
  return {
      "hall", std::string(32, 'a'), {"10.0.0.1:8420", "edge.local:80"}, secret};
}

std::string problem_of(const std::string& line) {
  std::string why;
  CHECK_FALSE(read_invitation(line, why));
  return why;
}

open_invitation open(const std::string& id, time_point until,
                     const std::string& name = {}) {
  return {id, secret, name, "node", {}, 0, until};
}

} // namespace

TEST_CASE("an invitation is a line, and comes back from it") {
  const auto line = line_of(one());
  CHECK(line
        == "roscell1:hall:" + std::string(32, 'a')
               + ":10.0.0.1:8420,edge.local:80:" + secret);
  std::string why;
  CHECK(read_invitation(line, why) == one());
  CHECK(read_invitation("  " + line + "\r\n", why) == one());
  CHECK(speaks_of(one(), std::string(64, 'a')));
  CHECK_FALSE(speaks_of(one(), std::string(31, 'a') + std::string(33, 'b')));
}

TEST_CASE("an invitation that is not whole is told by the part that is wrong") {
  const auto line = line_of(one());
  CHECK(problem_of("").find("one line") != std::string::npos);
  CHECK(problem_of(std::string(600, 'x')).find("512") != std::string::npos);
  CHECK(problem_of("x" + line).find("begins with") != std::string::npos);
  CHECK(problem_of("roscell1:Hall:").find("second") != std::string::npos);
  CHECK(problem_of("roscell1:hall:12:").find("third") != std::string::npos);
  const auto addresses = [](const std::string& text) {
    return problem_of("roscell1:hall:" + std::string(32, 'a') + ":" + text + ":"
                      + secret);
  };
  for (const auto* bad : {"", "a", "a:", "a:0", "a:65536", "a:1,", ",a:1",
                          "a b:1", "a:1,b:2,c:3,d:4,e:5,f:6,g:7,h:8,i:9"})
    CHECK(addresses(bad).find("fourth") != std::string::npos);
  CHECK(problem_of(line.substr(0, line.size() - 1)).find("is it whole")
        != std::string::npos);
  // Whatever is cut off, nothing else is read.
  for (size_t i = 0; i < line.size(); ++i)
    CHECK_FALSE(problem_of(line.substr(0, i)).empty());
}

TEST_CASE("that one has an invitation is proved for one connection") {
  const auto proof = prove_invitation(secret, "connection 1");
  CHECK(proves_invitation(secret, "connection 1", proof));
  CHECK_FALSE(proves_invitation(secret, "connection 2", proof));
  CHECK_FALSE(proves_invitation(std::string(32, 'c'), "connection 1", proof));
  CHECK_FALSE(proves_invitation(secret, "connection 1", ""));
  CHECK_FALSE(proves_invitation("", "connection 1",
                                prove_invitation("", "connection 1")));
  CHECK(id_of_invitation(secret).find(secret.substr(0, 8))
        == std::string::npos);
}

TEST_CASE("an invitation is good once, and until its end") {
  invitation_table table;
  const time_point start{};
  const auto end = start + 24h;
  CHECK(table.add(open("1", end), start));
  CHECK_FALSE(table.add(open("1", end), start));
  CHECK(table.add(open("2", end, "arm"), start));
  CHECK_FALSE(table.use("3", start));
  CHECK(table.find("1", start)->proving == secret);
  CHECK(table.use("1", start));
  CHECK(table.find("1", start) == nullptr);
  CHECK_FALSE(table.use("1", start));
  CHECK(table.find("2", end - 1ns) != nullptr);
  CHECK(table.find("2", end) == nullptr);
  CHECK(table.all(end).empty());
  CHECK_FALSE(table.use("2", end));
  CHECK(table.use("2", end - 1ns));
}

TEST_CASE("open invitations are bounded, and past ones make room") {
  invitation_table table;
  const time_point start{};
  for (size_t i = 0; i < limits::trust::invitations; ++i)
    REQUIRE(table.add(open(std::to_string(i), start + 1s), start));
  CHECK_FALSE(table.add(open("x", start + 9s), start));
  CHECK(table.use("0", start));
  CHECK(table.add(open("x", start + 9s), start));
  CHECK_FALSE(table.add(open("y", start + 9s), start));
  CHECK(table.add(open("y", start + 9s), start + 1s));
  CHECK(table.all(start + 1s).size() == 2);
}
