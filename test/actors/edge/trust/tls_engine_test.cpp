#include "actors/edge/trust/tls_engine.hpp"
#include "test/actors/edge/trust/site_fixture.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;

namespace {

/// A site whose members have connections.
struct connected_site : made_site {
  own_identity identity_of(site_role role, const std::string& who) const {
    auto made = issue(role, who);
    return {made.key, {made.mine}, mine};
  }

  tls_settings settings_of(const own_identity& own) const {
    return {own, [this] { return trust_now{trust, unix_s}; }};
  }

  tls_settings settings_of(site_role role, const std::string& who) const {
    return settings_of(identity_of(role, who));
  }

  int64_t unix_s = site_made_unix_s;
};

/// Both ends of one connection.
struct two_ends {
  two_ends(const tls_settings& server, const tls_settings& client,
           const char* protocol = session_protocol)
      : accepting(server, tls_engine::role::accepts),
        connecting(client, tls_engine::role::connects, protocol) {
    pass_on();
  }

  /// Until nobody has anything more to say.
  void pass_on() {
    for (;;) {
      const auto there = connecting.give();
      accepting.take(there);
      const auto back = accepting.give();
      connecting.take(back);
      wire += there + back;
      if (there.empty() && back.empty())
        return;
    }
  }

  /// What the accepting end has against the other; empty: nothing.
  std::string refusal() const {
    return accepting.problem() ? to_word(accepting.problem()->why) : "";
  }

  tls_engine accepting;
  tls_engine connecting;
  std::string wire; ///< All that has passed.
};

} // namespace

TEST_CASE("both ends of a connection know each other") {
  const connected_site site;
  two_ends x{site.settings_of(site_role::coordinator, "head"),
             site.settings_of(site_role::node, "arm")};
  REQUIRE(x.accepting.is_open());
  REQUIRE(x.connecting.is_open());
  CHECK(x.accepting.peer() == site.called(site_role::node, "arm"));
  CHECK(x.connecting.peer() == site.called(site_role::coordinator, "head"));
  CHECK(x.accepting.protocol() == session_protocol);
  CHECK(x.connecting.protocol() == session_protocol);
  CHECK(x.accepting.exported("heartbeat")
        == x.connecting.exported("heartbeat"));
  CHECK(x.accepting.exported("heartbeat") != x.accepting.exported("other"));
  two_ends other{site.settings_of(site_role::coordinator, "head"),
                 site.settings_of(site_role::node, "arm")};
  CHECK(other.accepting.exported("heartbeat")
        != x.accepting.exported("heartbeat"));
}

TEST_CASE("what passes through a connection cannot be read on the way") {
  const connected_site site;
  two_ends x{site.settings_of(site_role::coordinator, "head"),
             site.settings_of(site_role::node, "arm"), http_protocol};
  const std::string text(100'000, 'x');
  x.connecting.write("secret word");
  x.connecting.write(text);
  x.pass_on();
  std::string read;
  for (auto part = x.accepting.read(4096); !part.empty();
       part = x.accepting.read(4096))
    read += part;
  CHECK(read == "secret word" + text);
  x.accepting.write("answer");
  x.pass_on();
  CHECK(x.connecting.read(100) == "answer");
  CHECK(x.wire.find("secret") == std::string::npos);
  CHECK(x.wire.find("xxxxx") == std::string::npos);
  // Not even who it is that connects.
  CHECK(x.wire.find("arm") == std::string::npos);
  x.connecting.close();
  x.pass_on();
  CHECK(x.accepting.read(100).empty());
  CHECK(x.accepting.has_ended());
  CHECK_FALSE(x.accepting.problem());
}

TEST_CASE("bytes may come one by one") {
  const connected_site site;
  tls_engine server{site.settings_of(site_role::coordinator, "head"),
                    tls_engine::role::accepts};
  tls_engine client{site.settings_of(site_role::node, "arm"),
                    tls_engine::role::connects};
  for (int i = 0; i < 10; ++i) {
    for (const auto c : client.give())
      server.take({&c, 1});
    for (const auto c : server.give())
      client.take({&c, 1});
  }
  CHECK(server.is_open());
  CHECK(client.is_open());
}

TEST_CASE("who is not believed is refused by either end, and hears why") {
  connected_site site;
  const connected_site other;
  const auto head = site.identity_of(site_role::coordinator, "head");
  const auto arm = site.identity_of(site_role::node, "arm");
  const auto refused = [&](const tls_settings& client) {
    two_ends x{site.settings_of(head), client};
    CHECK_FALSE(x.accepting.is_open());
    x.connecting.read(1);
    CHECK(x.connecting.problem());
    return x.refusal();
  };
  CHECK(two_ends(site.settings_of(head), site.settings_of(arm)).refusal()
        == "");
  SECTION("of another site") {
    // It does not believe the accepting end, and says nothing.
    two_ends x{site.settings_of(head),
               other.settings_of(site_role::node, "arm")};
    CHECK(x.connecting.problem()->why == distrust::other_site);
    CHECK_FALSE(x.accepting.is_open());
    // Nor is it let in where it does.
    const auto of_other_site = other.identity_of(site_role::node, "arm");
    CHECK(refused(site.settings_of(of_other_site)) == "other_site");
  }
  SECTION("an issuer") {
    CHECK(refused(site.settings_of(site_role::issuer, "edge"))
          == "not_allowed");
  }
  SECTION("revoked") {
    revocation_list list{"hall"};
    list.add(arm.chain.front().serial(), site_made_unix_s * 2,
             site_made_unix_s);
    site.trust.revoked = std::make_shared<revocation_list>(list);
    CHECK(refused(site.settings_of(arm)) == "revoked");
  }
  SECTION("ended") {
    const auto client = site.settings_of(arm);
    // The site's own end lasts longer.
    const auto lasting = site.issue(site_role::operating, "head");
    two_ends good{site.settings_of({lasting.key, {lasting.mine}, site.mine}),
                  client};
    CHECK(good.accepting.is_open());
    site.unix_s = site_made_unix_s + 200 * limits::trust::day_s;
    two_ends x{site.settings_of({lasting.key, {lasting.mine}, site.mine}),
               client};
    CHECK(x.refusal() == "ended");
  }
}

TEST_CASE("who shows no certificate is nobody, and sees whom he has met") {
  const connected_site site;
  two_ends x{site.settings_of(site_role::coordinator, "head"),
             tls_settings::of_newcomer()};
  REQUIRE(x.accepting.is_open());
  CHECK_FALSE(x.accepting.peer());
  REQUIRE(x.connecting.is_open());
  CHECK_FALSE(x.connecting.peer());
  const auto chain = x.connecting.peer_chain();
  REQUIRE(chain.size() == 1);
  CHECK(site.distrust_of(chain).empty());
  CHECK(chain.front().who()->name == "head");
}

TEST_CASE("nothing is spoken but TLS 1.3") {
  const connected_site site;
  const auto server = site.settings_of(site_role::coordinator, "head");
  auto old = tls_settings::of_newcomer();
  SSL_CTX_set_min_proto_version(old.get(), TLS1_2_VERSION);
  SSL_CTX_set_max_proto_version(old.get(), TLS1_2_VERSION);
  two_ends x{server, old};
  CHECK_FALSE(x.accepting.is_open());
  REQUIRE(x.accepting.problem());
  CHECK(x.accepting.problem()->text.find("unsupported protocol")
        != std::string::npos);
  CHECK(x.connecting.problem());
  // Nor something else inside.
  two_ends odd{server, site.settings_of(site_role::node, "arm"), "h2"};
  CHECK_FALSE(odd.accepting.is_open());
  CHECK(odd.accepting.problem());
}

TEST_CASE("a handshake that makes no sense, or has no end, is broken off") {
  const connected_site site;
  const auto settings = site.settings_of(site_role::coordinator, "head");
  for (const auto& bytes : {std::string{"GET / HTTP/1.1\r\n\r\n"},
                            std::string(100, '\x16'), std::string(100, '\0')}) {
    tls_engine server{settings, tls_engine::role::accepts};
    server.take(bytes);
    CHECK(server.problem());
    // And nothing more is taken.
    server.take(bytes);
    CHECK(server.read(10).empty());
  }
  // A record of each 16 KiB that is whole takes no more than it may.
  tls_engine server{settings, tls_engine::role::accepts};
  const auto record = std::string{"\x16\x03\x01\x00\x01\x01", 6};
  for (size_t sent = 0;
       sent <= tls_engine::max_handshake_bytes && !server.problem();
       sent += record.size())
    server.take(record);
  CHECK(server.problem());
}

TEST_CASE("more certificates than a chain has are no chain") {
  const connected_site site;
  auto many = site.identity_of(site_role::node, "arm");
  for (int i = 0; i < 40; ++i)
    many.chain.push_back(site.issuer.mine);
  two_ends x{site.settings_of(site_role::coordinator, "head"),
             site.settings_of(many)};
  CHECK_FALSE(x.accepting.is_open());
  CHECK(x.accepting.problem());
}

TEST_CASE("a connection that was altered on the way is broken off") {
  const connected_site site;
  two_ends x{site.settings_of(site_role::coordinator, "head"),
             site.settings_of(site_role::node, "arm")};
  x.connecting.write("text");
  auto bytes = x.connecting.give();
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  x.accepting.take(bytes);
  CHECK(x.accepting.read(10).empty());
  CHECK(x.accepting.problem());
}

TEST_CASE("who was let in once shows his certificate again the next time") {
  const connected_site site;
  const auto client = site.settings_of(site_role::node, "arm");
  two_ends x{site.settings_of(site_role::coordinator, "head"), client};
  REQUIRE(x.accepting.is_open());
  // No ticket has come that would let it in without.
  CHECK(SSL_CTX_get_session_cache_mode(client.get()) == SSL_SESS_CACHE_OFF);
  x.accepting.write("hello");
  const auto bytes = x.accepting.give();
  CHECK(bytes.size() < 100);
}
