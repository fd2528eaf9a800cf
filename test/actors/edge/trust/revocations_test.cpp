#include "actors/edge/io/crypto.hpp"
#include "test/actors/edge/trust/site_fixture.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;

namespace {} // namespace

TEST_CASE("a revoked certificate counts no more, for renewal either") {
  made_site site;
  const auto arm = site.issue(site_role::node, "arm").mine;
  const auto by_issuer =
      site.issued_by_issuer(site.called(site_role::node, "b"));
  revocation_list list{"hall"};
  CHECK(list.add(arm.serial(), arm.ends_unix_s(), site_made_unix_s));
  CHECK(list.number() == 1);
  site.trust.revoked = std::make_shared<revocation_list>(list);
  CHECK(site.distrust_of({arm}) == "revoked");
  CHECK(site.distrust_of({arm}, site_made_unix_s, certificate_use::renewal)
        == "revoked");
  CHECK(site.distrust_of(by_issuer).empty());
  // With an issuer all go that it has signed.
  list.add(site.issuer.mine.serial(), site.issuer.mine.ends_unix_s(),
           site_made_unix_s);
  site.trust.revoked = std::make_shared<revocation_list>(list);
  CHECK(site.distrust_of(by_issuer) == "revoked");
}

TEST_CASE("of a revoked owner nothing counts that was made before") {
  made_site site;
  const auto before = site.issue(site_role::node, "arm").mine;
  const auto after =
      site.issue(site_role::node, "arm", site_made_unix_s + 20).mine;
  revocation_list list{"hall"};
  CHECK(list.add_owner(before.who()->uuid, site_made_unix_s + 10));
  CHECK(list.revokes(before));
  CHECK_FALSE(list.revokes(after));
  CHECK_FALSE(list.contains(before.serial()));
  const auto read =
      revocation_list::read(list.signed_text(site.key), site.mine);
  REQUIRE(read);
  CHECK(read->owners() == list.owners());
  CHECK(read->number() == 1);
}

TEST_CASE("a list of the revoked comes back as its site has signed it") {
  const made_site site;
  revocation_list list{"hall"};
  CHECK(revocation_list::read(list.signed_text(site.key), site.mine));
  list.add("0a", site_made_unix_s + 1, site_made_unix_s);
  list.add("ff", site_made_unix_s + 2, site_made_unix_s);
  const auto read =
      revocation_list::read(list.signed_text(site.key), site.mine);
  REQUIRE(read);
  CHECK(read->number() == 2);
  CHECK(read->serials() == list.serials());
}

TEST_CASE("a list of the revoked that was altered is none") {
  const made_site site;
  revocation_list list{"hall"};
  list.add("0a", site_made_unix_s + 1, site_made_unix_s);
  const auto good = list.signed_text(site.key);
  // Each byte counts.
  for (size_t i = 0; i < good.size(); ++i) {
    auto bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 1);
    INFO(i);
    CHECK_FALSE(revocation_list::read(bad, site.mine));
    CHECK_FALSE(revocation_list::read(good.substr(0, i), site.mine));
  }
  CHECK_FALSE(revocation_list::read(good + "x", site.mine));
  CHECK_FALSE(
      revocation_list::read(list.signed_text(made_site{}.key), site.mine));
  CHECK_FALSE(revocation_list::read(good, made_site{"yard"}.mine));
  CHECK_FALSE(revocation_list::read(
      std::string(limits::trust::revocations_bytes + 1, 'x'), site.mine));
}

TEST_CASE(
    "a list of the revoked is bounded, and forgets what is over for good") {
  revocation_list list{"hall"};
  for (size_t i = 0; i < limits::trust::revoked; ++i)
    REQUIRE(
        list.add(std::to_string(i), site_made_unix_s + 1, site_made_unix_s));
  CHECK_FALSE(list.add("abc", site_made_unix_s + 1, site_made_unix_s));
  CHECK(list.number() == static_cast<int64_t>(limits::trust::revoked));
  // It may be said again of one that is there.
  CHECK(list.add("0", site_made_unix_s + 1, site_made_unix_s));
  CHECK_FALSE(list.add("abc", site_made_unix_s + 1,
                       site_made_unix_s + limits::trust::renewal_s));
  CHECK(list.add("abc", site_made_unix_s + limits::trust::renewal_s,
                 site_made_unix_s + 2 + limits::trust::renewal_s));
  CHECK(list.serials().size() == 1);
  const made_site site;
  // As long as it can become, it is read.
  revocation_list full{"hall"};
  for (size_t i = 0; i < limits::trust::revoked; ++i)
    full.add(std::string(28, 'a')
                 + to_hex(std::string{static_cast<char>(i >> 8),
                                      static_cast<char>(i & 0xff)}),
             site_made_unix_s * 10, site_made_unix_s);
  CHECK(revocation_list::read(full.signed_text(site.key), site.mine));
}
