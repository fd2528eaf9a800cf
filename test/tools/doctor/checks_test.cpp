#include "tools/roscell/doctor/check.hpp"
#include "tools/roscell/doctor/findings_view.hpp"

#include <catch2/catch.hpp>

#include <atomic>
#include <future>
#include <stdexcept>

using namespace roscell;
using namespace roscell::cli;
using Catch::Contains;

namespace {

check named(const char* name, std::function<findings()> run_check) {
  return {name, "host", "something",
          [run_check = std::move(run_check)](const checked_host&) {
            return run_check();
          }};
}

findings two_findings() {
  findings all{
      {judgement::ok, "eth0 has 10.0.0.5"},
      {judgement::broken, "it is full", "nothing is kept", "rm /full"}};
  all[0].check = "interface";
  all[0].area = "network";
  all[1].check = "disk";
  all[1].area = "host";
  return all;
}

} // namespace

TEST_CASE("findings come in the order of the checks, with their names",
          "[doctor]") {
  const auto found = run_checks(
      {named("one",
             [] {
               return findings{{judgement::ok, "1"}};
             }),
       named("two", []() -> findings { throw std::runtime_error{"no"}; })},
      {}, [](auto&) { FAIL("nothing takes long"); });
  REQUIRE(found.size() == 2);
  CHECK(found[0].check == "one");
  CHECK(found[0].area == "host");
  CHECK(found[1].how == judgement::skipped);
  CHECK(found[1].seen == "it failed: no");
}

TEST_CASE("a check that hangs is told of, and is a finding", "[doctor]") {
  auto forever = std::make_shared<std::promise<void>>();
  std::vector<std::string> waited;
  const auto found = run_checks(
      {named("stuck",
             [forever] {
               forever->get_future().wait();
               return findings{};
             }),
       named("quick",
             [] {
               return findings{{judgement::ok, "1"}};
             })},
      {}, [&](const auto& names) { waited = names; },
      std::chrono::milliseconds{20});
  forever->set_value();
  CHECK(waited == std::vector<std::string>{"stuck"});
  REQUIRE(found.size() == 2);
  CHECK(found[0].how == judgement::broken);
  CHECK(found[0].seen == "it did not end in time");
  CHECK(found[1].how == judgement::ok);
}

TEST_CASE("a check that still hangs is not begun again", "[doctor]") {
  auto forever = std::make_shared<std::promise<void>>();
  const auto end = forever->get_future().share();
  auto begun = std::make_shared<std::atomic<int>>(0);
  const auto stuck = named("stuck again", [begun, end] {
    ++*begun;
    end.wait();
    return findings{{judgement::ok, "1"}};
  });
  const auto run_check = [&] {
    return run_checks(
        {stuck}, {}, [](auto&) {}, std::chrono::milliseconds{20});
  };
  CHECK(run_check()[0].how == judgement::broken);
  CHECK(run_check()[0].seen == "it did not end in time");
  CHECK(*begun == 1);
  forever->set_value();
  // What has ended meanwhile is told, or looked at anew.
  using namespace std::chrono_literals;
  CHECK(run_checks(
            {stuck}, {}, [](auto&) {}, 10s)[0]
            .how
        == judgement::ok);
}

TEST_CASE("each area is a table, and what is wrong has its command",
          "[doctor]") {
  CHECK(findings_view(two_findings(), {}, true)
        == "   NETWORK    SEEN\n"
           "✓  interface  eth0 has 10.0.0.5\n"
           "\n"
           "   HOST  SEEN\n"
           "✗  disk  it is full\n"
           "\n"
           "✗ disk: it is full\n"
           "    nothing is kept\n"
           "    $ rm /full\n"
           "\n"
           "1 broken, 0 warnings\n");
}

TEST_CASE("where there is no UTF-8 words stand for the signs", "[doctor]") {
  const auto text = findings_view(two_findings(), {}, false);
  CHECK_THAT(text, Contains("broken disk: it is full"));
  CHECK_THAT(text, !Contains("✗"));
}

TEST_CASE("findings are JSON for programs", "[doctor]") {
  const auto list = to_json_list(two_findings());
  CHECK(list[0].count("remedy") == 0);
  CHECK(list[1]
        == json({{"check", "disk"},
                 {"area", "host"},
                 {"verdict", "broken"},
                 {"seen", "it is full"},
                 {"matters", "nothing is kept"},
                 {"remedy", "rm /full"}}));
}
