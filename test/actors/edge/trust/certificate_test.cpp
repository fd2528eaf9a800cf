#include "test/actors/edge/trust/site_fixture.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr auto day = limits::trust::day_s;

std::vector<certificate> chain_of(const signer& x) {
  return {x.mine};
}

} // namespace

TEST_CASE("a key comes back from its file, and others are none") {
  const auto key = private_key::make();
  const auto read = private_key::from_pem(key.pem());
  REQUIRE(read);
  CHECK(digest_of_key(read->get()) == digest_of_key(key.get()));
  CHECK_FALSE(private_key::from_pem(""));
  CHECK_FALSE(private_key::from_pem("nonsense"));
  CHECK_FALSE(private_key::from_pem(key.pem().substr(0, 100)));
  const key_owner other{EVP_EC_gen("P-384")};
  CHECK_FALSE(is_site_key(other.get()));
}

TEST_CASE("a request for a certificate proves that its sender has the key") {
  const auto key = private_key::make();
  auto request = key.request();
  const auto found = key_in_request(request);
  REQUIRE(found);
  CHECK(digest_of_key(found.get()) == digest_of_key(key.get()));
  CHECK_FALSE(key_in_request(request + "x"));
  CHECK_FALSE(key_in_request(request.substr(0, request.size() - 1)));
  CHECK_FALSE(key_in_request(""));
  request.back() = static_cast<char>(request.back() ^ 1);
  CHECK_FALSE(key_in_request(request));
}

TEST_CASE("a certificate says whose it is, and for how long") {
  const made_site site;
  const auto arm = site.issue(site_role::node, "arm").mine;
  REQUIRE(arm.who());
  CHECK(*arm.who() == site.called(site_role::node, "arm"));
  CHECK(arm.begins_unix_s() == site_made_unix_s - day);
  CHECK(arm.ends_unix_s() == site_made_unix_s + 180 * day);
  CHECK(arm.serial().size() == 32);
  CHECK(arm.serial() != site.issue(site_role::node, "arm").mine.serial());
  CHECK(site.mine.site() == "hall");
  CHECK_FALSE(site.mine.who());
  const auto read = certificates_in(arm.pem() + site.mine.pem(), 2);
  REQUIRE(read);
  REQUIRE(read->size() == 2);
  CHECK(read->front().digest() == arm.digest());
  CHECK(read->back().site() == "hall");
}

TEST_CASE("of texts with certificates that cannot be read nothing is taken") {
  const made_site site;
  const auto pem = site.mine.pem();
  CHECK(certificates_in("", 2)->empty());
  CHECK_FALSE(certificates_in(pem + pem + pem, 2));
  auto broken = pem;
  broken[100] = '!';
  CHECK_FALSE(certificates_in(broken, 2));
  CHECK_FALSE(certificates_in(pem.substr(0, pem.size() / 2), 2));
  // A chain of forty.
  std::string many;
  for (int i = 0; i < 40; ++i)
    many += pem;
  CHECK_FALSE(certificates_in(many, limits::trust::chain + 1));
  CHECK_FALSE(certificate::from_der(""));
  CHECK_FALSE(certificate::from_der(std::string(100'000, 'x')));
}

TEST_CASE(
    "who was signed by the site, or by its issuer for a node, is believed") {
  const made_site site;
  for (const auto role : {site_role::node, site_role::coordinator,
                          site_role::operating, site_role::viewer})
    CHECK(site.distrust_of(chain_of(site.issue(role, "x"))).empty());
  const auto found = check_chain(
      site.trust, site.issued_by_issuer(site.called(site_role::node, "arm")),
      site_made_unix_s);
  REQUIRE(std::holds_alternative<identity>(found));
  CHECK(std::get<identity>(found).name == "arm");
}

TEST_CASE("an issuer signs for nodes alone, and nobody else signs") {
  const made_site site;
  for (const auto role : {site_role::coordinator, site_role::operating,
                          site_role::viewer, site_role::issuer})
    CHECK(site.distrust_of(site.issued_by_issuer(site.called(role, "x")))
          == "not_allowed");
  // An issuer is nobody who could open a session.
  CHECK(site.distrust_of(chain_of(site.issuer)) == "not_allowed");
  // What a node has signed is nothing.
  const auto arm = site.issue(site_role::node, "arm");
  const auto key = private_key::make();
  const auto other = make_certificate(site.called(site_role::node, "b"),
                                      key.get(), arm, site_made_unix_s, day);
  CHECK(site.distrust_of({other, arm.mine}) == "other_site");
  CHECK(site.distrust_of({}) == "no_certificate");
  CHECK(site.distrust_of({arm.mine, site.issuer.mine, site.mine})
        == "too_long");
  CHECK(site.distrust_of({site.mine}) == "nobody");
}

TEST_CASE("another site is not believed, though it has the same name") {
  const made_site site;
  const made_site other{"yard"};
  const made_site same;
  const auto of_other_site = chain_of(other.issue(site_role::node, "arm"));
  CHECK(site.distrust_of(of_other_site) == "other_site");
  CHECK(site.distrust_of(chain_of(same.issue(site_role::node, "arm")))
        == "other_site");
  // Nor with the issuer of this one beside it.
  CHECK(site.distrust_of(
            {same.issue(site_role::node, "arm").mine, site.issuer.mine})
        == "other_site");
}

TEST_CASE("a certificate is good from a day early to its end, and for its "
          "renewal two years longer") {
  const made_site site;
  const auto chain = chain_of(site.issue(site_role::node, "arm"));
  const auto begin = chain.front().begins_unix_s();
  const auto end = chain.front().ends_unix_s();
  const auto renewal = certificate_use::renewal;
  CHECK(site.distrust_of(chain, begin - day).empty());
  CHECK(site.distrust_of(chain, begin - day - 1) == "not_begun");
  CHECK(site.distrust_of(chain, end).empty());
  CHECK(site.distrust_of(chain, end + 1) == "ended");
  CHECK(site.distrust_of(chain, end + 200 * day, renewal).empty());
  CHECK(
      site.distrust_of(chain, end + limits::trust::renewal_s, renewal).empty());
  CHECK(site.distrust_of(chain, end + limits::trust::renewal_s + 1, renewal)
        == "ended");
}

TEST_CASE("no certificate outlives that of its signer") {
  const made_site site;
  const auto late = site.mine.ends_unix_s() - day;
  const auto x = site.issue(site_role::node, "arm", late).mine;
  CHECK(x.ends_unix_s() == site.mine.ends_unix_s());
}

TEST_CASE("a clock that was set back, or never set, is no reason to believe "
          "nobody") {
  CHECK(trusted_now(0, 0, site_made_unix_s) == site_made_unix_s);
  CHECK(trusted_now(0, site_made_unix_s + 5, site_made_unix_s)
        == site_made_unix_s + 5);
  CHECK(
      trusted_now(site_made_unix_s + 9, site_made_unix_s + 5, site_made_unix_s)
      == site_made_unix_s + 9);
  // When this program was built is later than 1970, too.
  CHECK(trusted_now(0, 0, 0) > 1'700'000'000);
}
