#include "actors/edge/process/skill_grants.hpp"

#include <catch2/catch.hpp>

#include <variant>

using namespace roscell;

namespace {

skill_grants granting(const std::vector<std::string>& lines) {
  const auto read = skill_grants::parse(lines);
  if (const auto* why = std::get_if<std::string>(&read))
    FAIL(*why);
  return std::get<skill_grants>(read);
}

std::string problem_of_grant(const std::string& line) {
  const auto read = skill_grants::parse({line});
  const auto* why = std::get_if<std::string>(&read);
  return why != nullptr ? *why : "none";
}

} // namespace

TEST_CASE("A grant is the skill's that it names, or all skills'", "[grants]") {
  const auto x = granting(
      {"ping=capability:NET_RAW,capability:KILL", "*=capability:SYS_NICE"});
  CHECK(x.allows_capability("ping", "NET_RAW"));
  CHECK(x.allows_capability("ping", "KILL"));
  CHECK(x.allows_capability("ping", "SYS_NICE"));
  CHECK(x.allows_capability("other", "SYS_NICE"));
  CHECK_FALSE(x.allows_capability("other", "NET_RAW"));
  CHECK_FALSE(x.allows_capability("ping", "NET_ADMIN"));
  CHECK_FALSE(skill_grants{}.allows_capability("ping", "NET_RAW"));
}

TEST_CASE("The user of a skill counts more than the one of all", "[grants]") {
  const auto x = granting({"ping=user:ann", "*=user:bob"});
  CHECK(x.user_of("ping") == "ann");
  CHECK(x.user_of("other") == "bob");
  CHECK(granting({"*=user:bob", "ping=user:ann"}).user_of("ping") == "ann");
  CHECK(skill_grants{}.user_of("ping").empty());
}

TEST_CASE("Real time is granted up to a priority, of one policy", "[grants]") {
  const auto x = granting({"drive=scheduling:fifo:50"});
  CHECK(x.allows_scheduling("drive", {"fifo", 50, 0}));
  CHECK(x.allows_scheduling("drive", {"fifo", 1, 0}));
  CHECK_FALSE(x.allows_scheduling("drive", {"fifo", 51, 0}));
  CHECK_FALSE(x.allows_scheduling("drive", {"rr", 10, 0}));
  CHECK_FALSE(x.allows_scheduling("drive", {"other", 0, -1}));
  CHECK_FALSE(x.allows_scheduling("other", {"fifo", 1, 0}));
  CHECK(granting({"*=scheduling:rr:9"}).allows_scheduling("x", {"rr", 9, 0}));
}

TEST_CASE("A nice value is granted down to a bound, higher ones to everybody",
          "[grants]") {
  const auto x = granting({"drive=scheduling:nice:-5"});
  CHECK(x.allows_scheduling("drive", {"other", 0, -5}));
  CHECK(x.allows_scheduling("drive", {"", 0, -1}));
  CHECK_FALSE(x.allows_scheduling("drive", {"other", 0, -6}));
  CHECK_FALSE(x.allows_scheduling("drive", {"fifo", 1, 0}));
  for (const auto* policy : {"", "other", "batch", "idle"})
    CHECK(skill_grants{}.allows_scheduling("drive", {policy, 0, 19}));
}

TEST_CASE("What a deployment lacks is told as what would grant it",
          "[grants]") {
  deployment_option wanted;
  wanted.capabilities = {"NET_RAW", "KILL"};
  wanted.scheduling = {"fifo", 7, 0};
  const auto x = granting({"ping=capability:KILL"});
  CHECK(x.missing("ping", wanted)
        == std::vector<std::string>{"capability:NET_RAW", "scheduling:fifo:7"});
  CHECK(granting({"ping=capability:NET_RAW,capability:KILL,scheduling:fifo:7"})
            .missing("ping", wanted)
            .empty());
  CHECK(refusal_text("ping", "arm", "capability:NET_RAW")
        == "skill 'ping' wants capability NET_RAW, which node 'arm' does not "
           "grant it: grant = ping=capability:NET_RAW");
}

TEST_CASE("A grant that means nothing is refused", "[grants]") {
  for (const auto* line : {"ping", "=capability:KILL", "ping=", "ping=KILL",
                           "ping=user:", "ping=capability:", "ping=x:y",
                           "ping=capability:KILL,,capability:KILL"})
    CHECK(problem_of_grant(line) != "none");
  CHECK(problem_of_grant("ping=capability:CAP_KILL")
        == "there is no capability 'CAP_KILL'; `man 7 capabilities` lists "
           "them, NET_RAW is one");
  CHECK(problem_of_grant("ping=scheduling:fifo:100")
        == "'100' is no priority from 1 to 99");
  CHECK(problem_of_grant("ping=scheduling:rr:0")
        == "'0' is no priority from 1 to 99");
  CHECK(problem_of_grant("ping=scheduling:nice:-21")
        == "'-21' is no nice value from -20 to -1; higher ones need no grant");
  CHECK(problem_of_grant("ping=scheduling:nice:1") != "none");
  CHECK(problem_of_grant("ping=scheduling:deadline:1")
        == "'deadline' is not fifo, rr or nice");
}
