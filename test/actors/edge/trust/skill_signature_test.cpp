#include "actors/edge/trust/skill_signature.hpp"
#include "test/actors/edge/trust/site_people.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;

namespace {

const std::string build_hash(64, 'a');

std::string distrust_in(const site_of_today& site, const std::string& signature,
                        const std::string& hash = build_hash) {
  const auto found =
      check_signature({site.mine, nullptr}, signature, hash, clock_unix_s());
  const auto* why = std::get_if<distrusted>(&found);
  return why == nullptr ? "" : to_word(why->why);
}

} // namespace

TEST_CASE("a build is signed by an operator of the site, and by nobody else") {
  const site_of_today site;
  const auto anna = site.issue(site_role::operating, "anna", "0a");
  const auto good = sign_build(anna, build_hash);
  CHECK(distrust_in(site, good).empty());
  CHECK(distrust_in(site, good, std::string(64, 'b')) == "nobody");
  CHECK(distrust_in(site_of_today{}, good) == "other_site");
  for (const auto role :
       {site_role::node, site_role::coordinator, site_role::viewer})
    CHECK(distrust_in(site, sign_build(site.issue(role, "x", "0b"), build_hash))
          == "not_allowed");
}

TEST_CASE("a signature of a build that was altered is none") {
  const site_of_today site;
  const auto good =
      sign_build(site.issue(site_role::operating, "anna", "0a"), build_hash);
  for (const auto* text : {"", "signature ", "signature 00\n"})
    CHECK_FALSE(distrust_in(site, text).empty());
  for (size_t i = good.rfind("signature"); i < good.size(); ++i) {
    auto bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 1);
    CHECK_FALSE(distrust_in(site, bad).empty());
    CHECK_FALSE(distrust_in(site, good.substr(0, i)).empty());
  }
  CHECK_FALSE(distrust_in(site, good + "x").empty());
  CHECK_FALSE(distrust_in(site, std::string(100'000, 'x')).empty());
}

TEST_CASE("who was revoked signs no more") {
  const site_of_today site;
  const auto anna = site.issue(site_role::operating, "anna", "0a");
  revocation_list list{"hall"};
  REQUIRE(list.add_owner("0a", clock_unix_s()));
  const auto found = check_signature(
      {site.mine, std::make_shared<const revocation_list>(list)},
      sign_build(anna, build_hash), build_hash, clock_unix_s());
  REQUIRE(std::holds_alternative<distrusted>(found));
  CHECK(std::get<distrusted>(found).why == distrust::revoked);
}
