#include "actors/edge/http/client/site_door.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/sealed_text.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/site.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"
#include "test/actors/edge/trust/site_people.hpp"

#include <chrono>
#include <string>

namespace roscell::test::wire {

namespace {

const std::string door_secret(32, 'c');

/// A node of a site at whose door newcomers come; it gives them what it has.
struct site_host {
  explicit site_host(const site_of_today& at,
                     site_role role = site_role::coordinator)
      : site(at), own(at.person(role, "head", "ffff")) {
    http_server_options options;
    options.port = 0;
    options.identity = own;
    options.handler = [this](const http_request& x, const responder& answer) {
      asked.put(x.role + " " + x.method + " " + x.path + " "
                + (x.peer.empty() ? "nobody" : "somebody"));
      answer.reply(200, json_content, answer_to(x));
    };
    options.on_distrusted = [this](const std::string&, const distrusted& why) {
      refused.put(to_word(why.why));
    };
    server = expect(http_server::start(io, std::move(options)));
  }

  std::string answer_to(const http_request& x) const {
    const auto said = json::parse(x.body).get<site_entry>();
    const auto proving = proving_half(door_secret);
    if (said.invitation != id_of_invitation(proving)
        || !proves_invitation(proving, *from_hex(x.exported), said.proof))
      return error_body(error_code::unauthorized, "no such invitation");
    site_entered result;
    const auto key = key_in_request(*from_hex(said.request));
    result.chain =
        make_certificate({site.name, site_role::node, said.node, said.uuid},
                         key.get(), {site.key, site.mine}, clock_unix_s(), 1000)
            .pem();
    result.site = site.mine.pem();
    result.deposit = deposit;
    return message_json(result).dump();
  }

  void open() {
    own->expect_newcomers(std::chrono::steady_clock::now()
                          + std::chrono::hours{1});
  }

  edge_result<kept_identity> enter(const certificate& of) const {
    return enter_site({site.name,
                       of.digest().substr(0, invitation_digits),
                       {"127.0.0.1:" + std::to_string(server->port())},
                       door_secret},
                      {"arm", "0c0d"});
  }

  error_code refusal(const certificate& of) const {
    const auto got = enter(of);
    const auto* why = std::get_if<edge_error>(&got);
    REQUIRE(why != nullptr);
    return why->code;
  }

  const site_of_today& site;
  std::shared_ptr<site_identity> own;
  std::string deposit;
  inbox<std::string> asked;
  inbox<std::string> refused;
  io_thread io;
  std::unique_ptr<http_server> server;
};

} // namespace

TEST_CASE(
    "a newcomer gets an identity at the door of the site he was told of") {
  const site_of_today site;
  site_host host{site};
  host.open();
  const auto got = expect(host.enter(site.mine));
  CHECK(got.own.who() == identity{"hall", site_role::node, "arm", "0c0d"});
  CHECK(got.own.site.digest() == site.mine.digest());
  CHECK(host.asked.take() == "newcomer POST /v1/site/entry nobody");
}

TEST_CASE("what waits for a newcomer only he can open") {
  const site_of_today site;
  site_host host{site};
  host.open();
  const auto anna = site.issue(site_role::operating, "anna", "0e");
  host.deposit = to_hex(seal_text(door_secret, deposit_of({anna})));
  CHECK(expect(host.enter(site.mine)).own.who() == anna.who());
  host.deposit = to_hex(seal_text(std::string(32, 'd'), deposit_of({anna})));
  CHECK(host.refusal(site.mine) == error_code::schema_violation);
}

TEST_CASE("a newcomer believes no other site, and no node in a coordinator's "
          "place") {
  const site_of_today site;
  const site_of_today other;
  SECTION("of the same name") {
    site_host host{other};
    host.open();
    CHECK(host.refusal(site.mine) == error_code::unauthorized);
  }
  SECTION("a node") {
    site_host host{site, site_role::node};
    host.open();
    CHECK(host.refusal(site.mine) == error_code::unauthorized);
  }
}

TEST_CASE("without an open invitation nobody says a word at the door") {
  const site_of_today site;
  site_host host{site};
  CHECK(host.refusal(site.mine) == error_code::unreachable);
  CHECK(host.refused.take() == "no_certificate");
}

TEST_CASE("who is of the site comes to the door without an invitation") {
  const site_of_today site;
  site_host host{site};
  http_endpoint to{"",
                   "127.0.0.1",
                   host.server->port(),
                   "",
                   site.person(site_role::node, "arm", "0c0d"),
                   "ffff"};
  to.protocol = entry_protocol;
  const http_client client{to};
  (void)expect(client.request("POST", "/v1/site/renewal",
                              message_json(site_renewal{}).dump(), {}));
  CHECK(host.asked.take() == "newcomer POST /v1/site/renewal somebody");
}

} // namespace roscell::test::wire
