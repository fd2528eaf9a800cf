#include "test/actors/edge/session/session_fixture.hpp"
#include "test/actors/edge/trust/site_people.hpp"
#include "test/temp_folder.hpp"

#include <fstream>

namespace roscell::test::wire {

namespace {

/// A coordinator that takes sessions by identities.
struct secure_acceptor {
  explicit secure_acceptor(std::shared_ptr<site_identity> own) {
    http_server_options options;
    options.port = 0;
    options.identity = own;
    options.handler = [](const http_request&, const responder& answer) {
      answer.reply(200, "text/plain", "hello");
    };
    options.on_distrusted = [this](const std::string&, const distrusted& why) {
      refused.put(to_word(why.why));
    };
    server = expect(http_server::start(io, std::move(options)));
    session_acceptor acceptor;
    acceptor.identity = base_node;
    acceptor.site = site_secret::of_identity(own);
    acceptor.on_session = [this](established_session session) {
      sessions.put(std::move(session));
    };
    acceptor.on_refused = [this](const std::string&, const edge_error& why) {
      refused.put(to_string(why.code));
    };
    server->accept_sessions(std::move(acceptor));
  }

  session_result join(const site_secret& by,
                      joiner_identity identity = robot_node) {
    inbox<session_result> outcome;
    connect_session(io, {"127.0.0.1", server->port(), {}}, std::move(identity),
                    by, {},
                    [&](session_result x) { outcome.put(std::move(x)); });
    return outcome.take();
  }

  error_code refusal(const site_secret& by,
                     joiner_identity identity = robot_node) {
    auto result = join(by, std::move(identity));
    REQUIRE(std::holds_alternative<edge_error>(result));
    return std::get<edge_error>(result).code;
  }

  inbox<established_session> sessions;
  inbox<std::string> refused;
  io_thread io;
  std::unique_ptr<http_server> server;
};

std::shared_ptr<site_identity> base_of(const site_of_today& site) {
  return site.person(site_role::coordinator, base_node.node, base_node.uuid);
}

site_secret robot_of(const site_of_today& site,
                     site_role role = site_role::node,
                     const std::string& name = robot_node.node,
                     const std::string& uuid = robot_node.uuid) {
  return site_secret::of_identity(site.person(role, name, uuid));
}

} // namespace

TEST_CASE("a session of identities passes frames, and its keys are its own") {
  const site_of_today site;
  secure_acceptor base{base_of(site)};
  const auto robot = robot_of(site);
  std::string former;
  for (int i = 0; i < 2; ++i) {
    auto joined = base.join(robot);
    REQUIRE(std::holds_alternative<established_session>(joined));
    auto& here = std::get<established_session>(joined);
    auto there = base.sessions.take();
    CHECK(there.peer.node == robot_node.node);
    CHECK(here.peer.cell == base_node.cell);
    CHECK(here.agreement.keys.send == there.agreement.keys.receive);
    CHECK(here.agreement.keys.receive == there.agreement.keys.send);
    CHECK(here.agreement.session != former);
    former = here.agreement.session;
    session_ear ear;
    there.link->start(ear.callbacks());
    const std::string large(300'000, 'x');
    CHECK(here.link->send("hello"));
    CHECK(here.link->send(large));
    CHECK(ear.frames.take() == "hello");
    CHECK(ear.frames.take() == large);
    here.link->close("over");
    CHECK(ear.ends.take().why == session_end::cause::closed_there);
  }
}

TEST_CASE("nobody gets a session but the node that its identity names") {
  const site_of_today site;
  secure_acceptor base{base_of(site)};
  SECTION("another name") {
    CHECK(base.refusal(robot_of(site, site_role::node, "robot-2"))
          == error_code::unauthorized);
  }
  SECTION("another UUID") {
    CHECK(base.refusal(robot_of(site, site_role::node, "robot-1", "0a1c"))
          == error_code::unauthorized);
  }
  SECTION("a person") {
    CHECK(base.refusal(robot_of(site, site_role::operating))
          == error_code::unauthorized);
  }
  SECTION("a node that calls itself a coordinator") {
    auto posing = robot_node;
    posing.role = coordinator_role;
    CHECK(base.refusal(robot_of(site), posing) == error_code::unauthorized);
  }
  SECTION("another site that has the same name") {
    const site_of_today other;
    CHECK(base.refusal(robot_of(other)) == error_code::unauthorized);
  }
  SECTION("one who has a token") {
    (void)base.refusal("a-token-of-the-site");
  }
  CHECK(base.sessions.size() == 0);
}

TEST_CASE("a joiner says nothing to who is no coordinator of its site") {
  const site_of_today site;
  SECTION("a node") {
    secure_acceptor base{
        site.person(site_role::node, base_node.node, base_node.uuid)};
    CHECK(base.refusal(robot_of(site)) == error_code::unauthorized);
  }
  SECTION("another one than it calls itself") {
    secure_acceptor base{
        site.person(site_role::coordinator, "other", base_node.uuid)};
    CHECK(base.refusal(robot_of(site)) == error_code::unauthorized);
    CHECK(base.sessions.size() == 0);
  }
  SECTION("one that speaks plain HTTP") {
    acceptor_fixture plain;
    inbox<session_result> outcome;
    connect_session(plain.io, plain.target(), robot_node, robot_of(site), {},
                    [&](session_result x) { outcome.put(std::move(x)); });
    auto result = outcome.take();
    REQUIRE(std::holds_alternative<edge_error>(result));
    CHECK(std::get<edge_error>(result).code == error_code::unauthorized);
    plain.io.stop();
  }
}

TEST_CASE("who is revoked is refused from the next handshake on") {
  const site_of_today site;
  const temp_folder folder;
  const auto file = folder.path() / "revoked";
  secure_acceptor base{site.person(site_role::coordinator, base_node.node,
                                   base_node.uuid, file)};
  const auto own =
      site.issue(site_role::node, robot_node.node, robot_node.uuid);
  const auto robot = site_secret::of_identity(
      std::make_shared<site_identity>(own, std::filesystem::path{}));
  REQUIRE(std::holds_alternative<established_session>(base.join(robot)));
  revocation_list list{site.name};
  REQUIRE(list.add(own.chain.front().serial(), own.chain.front().ends_unix_s(),
                   clock_unix_s()));
  std::ofstream{file} << list.signed_text(site.key);
  CHECK(base.refusal(robot) == error_code::unauthorized);
  CHECK(base.refused.take() == "revoked");
  // Whoever takes the list away lets nobody in by that.
  std::filesystem::remove(file);
  (void)base.refusal(robot);
  CHECK(base.refused.take() == "revoked");
}

} // namespace roscell::test::wire
