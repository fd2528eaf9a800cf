#include "actors/edge/trust/identity.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

constexpr const char* uuid = "0a1b2c3d-0000-4000-8000-000000000001";

} // namespace

TEST_CASE("an identity is a URI, and comes back from it") {
  for (const auto role :
       {site_role::node, site_role::coordinator, site_role::operating,
        site_role::viewer, site_role::issuer}) {
    const identity x{"hall-2", role, "Arm_1.left", uuid};
    const auto read = identity_in(uri_of(x));
    REQUIRE(read);
    CHECK(*read == x);
    CHECK(role_from(to_word(role)) == role);
  }
  CHECK(uri_of({"hall", site_role::operating, "ann", uuid})
        == "spiffe://hall/operator/ann/" + std::string{uuid});
}

TEST_CASE("what is no URI of an identity is none") {
  const std::string good = "spiffe://hall/node/arm/" + std::string{uuid};
  REQUIRE(identity_in(good));
  for (const auto& bad :
       {std::string{}, std::string{"spiffe://"}, std::string{"spiffe://hall"},
        "https" + good.substr(6), good + "/", good + "/x", good + "\n",
        good + std::string(1, '\0'), std::string{"spiffe://hall/node/arm/"},
        "spiffe://Hall/node/arm/" + std::string{uuid},
        "spiffe://-hall/node/arm/" + std::string{uuid},
        "spiffe://hall/root/arm/" + std::string{uuid},
        "spiffe://hall/node//" + std::string{uuid},
        "spiffe://hall/node/a b/" + std::string{uuid},
        "spiffe://hall/node/" + std::string(64 * 1024, 'x') + "/"
            + std::string{uuid}}) {
    INFO(bad.substr(0, 80));
    CHECK_FALSE(identity_in(bad));
  }
}

TEST_CASE("a name of a site is part of a name in DNS") {
  CHECK(is_site_name("a"));
  CHECK(is_site_name(std::string(63, 'a')));
  CHECK_FALSE(is_site_name(std::string(64, 'a')));
  for (const auto* bad : {"", "A", "a_b", "a.b", "-a", "a-", "a b", "ä"})
    CHECK_FALSE(is_site_name(bad));
  CHECK(dns_name_of({"hall", site_role::node, "Arm_1.left", uuid})
        == "arm-1-left.hall.roscell.internal");
  CHECK(site_in(uri_of_site("hall")) == "hall");
  CHECK_FALSE(site_in("spiffe://hall/node"));
}
