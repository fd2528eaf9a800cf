#include "actors/site/site_keeper.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/identity_place.hpp"
#include "actors/edge/trust/invitation.hpp"
#include "actors/site/limits.hpp"
#include "test/actors/edge/trust/site_people.hpp"
#include "test/fixture.hpp"
#include "test/temp_folder.hpp"

#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;

namespace {

const std::string secret(32, 'b');
const std::string exported(64, 'e');

/// The site keeper of a node, at a site of today.
struct keeper_of_site : virtual_time {
  explicit keeper_of_site(bool coordinator = true, bool identified = true,
                          int64_t good_for_s = limits::trust::machine_s) {
    config.context = context;
    config.node = coordinator ? "head" : "arm";
    config.uuid = "0a1b";
    config.coordinator = coordinator;
    config.file = data.path() / "identity.pem";
    config.addresses = {"10.0.0.1:8420"};
    config.start_anew = [this] { ++started_anew; };
    config.ask = [this](http_call call,
                        const std::function<void(http_outcome)>&) {
      asked.push_back(std::move(call));
    };
    if (identified)
      identify(good_for_s);
    start();
  }

  ~keeper_of_site() {
    kill(keeper);
  }

  void identify(int64_t good_for_s) {
    const auto role =
        config.coordinator ? site_role::coordinator : site_role::node;
    const auto made = private_key::make();
    const own_identity own{
        made,
        {make_certificate({site.name, role, config.node, config.uuid},
                          made.get(), {site.key, site.mine}, clock_unix_s(),
                          good_for_s)},
        site.mine};
    const auto issuing = site.issue(site_role::issuer, "head", config.uuid);
    REQUIRE_FALSE(keep_identity(config.file, {own, text_of(issuing)}));
    config.identity =
        std::make_shared<site_identity>(own, revoked_file_of(config.file));
  }

  void meet(bool present, int64_t revocations = 0) {
    caf::anon_send(
        keeper, note_coordinator{"10.0.0.1:8420", "0f", present, revocations});
    settle();
  }

  void answer(const site_entered& x) {
    caf::anon_send(keeper, renewal_answered{message_json(x).dump(), ""});
    settle();
  }

  bool wants_certificate() const {
    return json::parse(asked.back().body).value("certificate", false);
  }

  void start() {
    keeper = spawn(system, config.context, site_keeper, config);
    settle();
  }

  template <class Reply, class Request>
  caf::expected<Reply> say(const Request& request) {
    auto reply = ask<Reply>(keeper, request);
    settle();
    return **reply;
  }

  caf::expected<site_invited> invite(const std::string& node = {},
                                     const std::string& role = "node",
                                     const std::string& deposit = {}) {
    return say<site_invited>(
        site_invitation{node, role, proving_half(secret), deposit});
  }

  site_entry entry_of(const std::string& node) const {
    const auto proving = proving_half(secret);
    return {id_of_invitation(proving),
            prove_invitation(proving, *from_hex(exported)),
            node,
            "0c0d",
            to_hex(key.request()),
            exported};
  }

  caf::expected<site_entered> enter(const std::string& node = "arm") {
    return say<site_entered>(entry_of(node));
  }

  std::string list_without(const certificate& x) const {
    revocation_list list{site.name};
    list.add(x.serial(), x.ends_unix_s(), clock_unix_s());
    return list.signed_text(site.key);
  }

  temp_folder data;
  site_of_today site;
  private_key key = private_key::make();
  site_keeper_config config;
  site_keeper_actor keeper;
  int started_anew = 0;
  std::vector<http_call> asked; ///< Of coordinators.
};

template <class T>
error_code code_of(const caf::expected<T>& x) {
  return to_failure(x.error()).code;
}

} // namespace

TEST_CASE("who shows an invitation gets an identity of his own key, once") {
  keeper_of_site bench;
  CHECK_FALSE(bench.config.identity->expects_newcomers());
  REQUIRE(bench.invite());
  CHECK(bench.config.identity->expects_newcomers());
  const auto got = bench.enter();
  REQUIRE(got);
  const auto read = read_identity(bench.key.pem() + got->chain + got->site);
  REQUIRE(std::holds_alternative<own_identity>(read));
  const auto& own = std::get<own_identity>(read);
  const auto found =
      check_chain({bench.site.mine, nullptr}, own.chain, clock_unix_s());
  REQUIRE(std::holds_alternative<identity>(found));
  CHECK(std::get<identity>(found)
        == identity{"hall", site_role::node, "arm", "0c0d"});
  CHECK(code_of(bench.enter()) == error_code::unauthorized);
  CHECK_FALSE(bench.config.identity->expects_newcomers());
}

TEST_CASE("an invitation that is not proved stays, and lets nobody in") {
  keeper_of_site bench;
  REQUIRE(bench.invite("arm"));
  auto forged = bench.entry_of("arm");
  forged.proof = std::string(64, '0');
  CHECK(code_of(bench.say<site_entered>(forged)) == error_code::unauthorized);
  // A proof of another connection.
  auto replayed = bench.entry_of("arm");
  replayed.exported = std::string(64, 'f');
  CHECK(code_of(bench.say<site_entered>(replayed)) == error_code::unauthorized);
  auto unknown = bench.entry_of("arm");
  unknown.invitation = std::string(32, '0');
  CHECK(code_of(bench.say<site_entered>(unknown)) == error_code::unauthorized);
  auto spoiled = bench.entry_of("arm");
  spoiled.request = "3082";
  CHECK(code_of(bench.say<site_entered>(spoiled))
        == error_code::schema_violation);
  CHECK(code_of(bench.enter("belt")) == error_code::unauthorized);
  CHECK(bench.enter("arm"));
}

TEST_CASE("what a known node is called goes with an invitation for it alone") {
  keeper_of_site bench;
  bench.config.known->add("arm", "0c0d");
  REQUIRE(bench.invite());
  // His own UUID does not help, nor does another one.
  CHECK(code_of(bench.enter("arm")) == error_code::unauthorized);
  auto other = bench.entry_of("arm");
  other.uuid = "0e";
  CHECK(code_of(bench.say<site_entered>(other)) == error_code::unauthorized);
  // Nor may somebody have his UUID under another name, or be the coordinator.
  CHECK(code_of(bench.enter("belt")) == error_code::unauthorized);
  auto head = bench.entry_of("head");
  head.uuid = "0e";
  CHECK(code_of(bench.say<site_entered>(head)) == error_code::unauthorized);
  // None of that has used it up.
  other.node = "leg";
  CHECK(bench.say<site_entered>(other));
  keeper_of_site named;
  named.config.known->add("arm", "0c0d");
  REQUIRE(named.invite("arm"));
  CHECK(named.enter("arm"));
}

TEST_CASE("a certificate is renewed past half of its time, and asked for again "
          "after a pause") {
  keeper_of_site fresh{false};
  fresh.meet(true);
  CHECK(fresh.asked.empty());
  constexpr int64_t short_s = 1000;
  keeper_of_site bench{false, true, short_s};
  bench.meet(true);
  REQUIRE(bench.asked.size() == 1);
  CHECK(bench.wants_certificate());
  CHECK(bench.asked.front().to.uuid == "0f");
  // Who is asked has not answered yet.
  bench.meet(true);
  CHECK(bench.asked.size() == 1);
  caf::anon_send(bench.keeper, renewal_answered{"", "it does not answer"});
  bench.settle();
  bench.advance(limits::site::renewal_pause - std::chrono::seconds{1});
  CHECK(bench.asked.size() == 1);
  bench.advance(std::chrono::seconds{1});
  REQUIRE(bench.asked.size() == 2);
  const auto now = bench.config.identity->own();
  const auto made = make_certificate(now.who(), now.key.get(),
                                     {bench.site.key, bench.site.mine},
                                     clock_unix_s(), limits::trust::machine_s);
  bench.answer({made.pem(), bench.site.mine.pem(), "", ""});
  CHECK(bench.config.identity->own().chain.front().serial() == made.serial());
  CHECK(std::get<own_identity>(read_identity_file(bench.config.file))
            .chain.front()
            .serial()
        == made.serial());
  bench.meet(true);
  CHECK(bench.asked.size() == 2);
}

TEST_CASE("a certificate of another node or key is no renewal") {
  constexpr int64_t short_s = 1000;
  keeper_of_site bench{false, true, short_s};
  const auto before = bench.config.identity->own().chain.front().serial();
  bench.meet(true);
  const auto offer = [&](const std::string& name, EVP_PKEY* key) {
    bench.answer({make_certificate({"hall", site_role::node, name, "0a1b"}, key,
                                   {bench.site.key, bench.site.mine},
                                   clock_unix_s(), short_s)
                      .pem(),
                  bench.site.mine.pem(), "", ""});
  };
  offer("belt", bench.config.identity->own().key.get());
  offer("arm", bench.key.get());
  CHECK(bench.config.identity->own().chain.front().serial() == before);
}

TEST_CASE("a longer list of the revoked is fetched, and no certificate") {
  keeper_of_site bench{false};
  bench.meet(true, 1);
  REQUIRE(bench.asked.size() == 1);
  CHECK_FALSE(bench.wants_certificate());
  const auto belt = bench.site.issue(site_role::node, "belt", "0e");
  bench.answer(
      {"", bench.site.mine.pem(), bench.list_without(belt.chain.front()), ""});
  CHECK(bench.config.identity->trust().site.revoked->number() == 1);
  bench.meet(true, 1);
  CHECK(bench.asked.size() == 1);
}

TEST_CASE("an answer that comes too late does not undo another identity") {
  constexpr int64_t short_s = 1000;
  keeper_of_site bench{false, true, short_s};
  bench.meet(true);
  const auto asked = bench.say<identity_requested>(identity_request_query{});
  const auto own = key_in_request(*from_hex(asked->request));
  const site_of_today other{"yard"};
  const auto made =
      make_certificate({"yard", site_role::node, "arm", "0a1b"}, own.get(),
                       {other.key, other.mine}, clock_unix_s(), short_s);
  const auto set = bench.say<identity_set>(
      identity_setting{"", made.pem(), "", other.mine.pem(), ""});
  REQUIRE(set);
  CHECK(set->later);
  const auto now = bench.config.identity->own();
  bench.answer({make_certificate(now.who(), now.key.get(),
                                 {bench.site.key, bench.site.mine},
                                 clock_unix_s(), short_s)
                    .pem(),
                bench.site.mine.pem(), "", ""});
  CHECK(std::get<own_identity>(read_identity_file(bench.config.file)).who().site
        == "yard");
  CHECK(code_of(bench.say<revocations_set>(revocation_setting{
            "", revocation_list{"hall"}.signed_text(bench.site.key)}))
        == error_code::conflict);
}

TEST_CASE("an invitation is over after a day") {
  keeper_of_site bench;
  REQUIRE(bench.invite());
  bench.advance(limits::trust::invitation - std::chrono::seconds{1});
  CHECK(bench.say<site_status>(site_query{})->invitations.size() == 1);
  bench.advance(std::chrono::seconds{1});
  CHECK(bench.say<site_status>(site_query{})->invitations.empty());
  CHECK(code_of(bench.enter()) == error_code::unauthorized);
}

TEST_CASE("what was made elsewhere is kept for whom it is for") {
  keeper_of_site bench;
  REQUIRE(bench.invite("", "operator", "c0ffee"));
  const auto got = bench.enter("person");
  REQUIRE(got);
  CHECK(got->deposit == "c0ffee");
  CHECK(got->chain.empty());
}

TEST_CASE("a coordinator invites as no more than a node by itself") {
  keeper_of_site bench;
  CHECK(code_of(bench.invite("", "operator")) == error_code::schema_violation);
  keeper_of_site member{false};
  CHECK(code_of(member.invite()) == error_code::conflict);
  keeper_of_site with_token{true, false};
  CHECK(code_of(with_token.invite()) == error_code::conflict);
  CHECK(code_of(with_token.enter()) == error_code::conflict);
}

TEST_CASE("a coordinator renews a node's certificate, and no other") {
  keeper_of_site bench;
  const auto arm = bench.site.issue(site_role::node, "arm", "0c0d");
  const auto got =
      bench.say<site_entered>(site_renewal{true, arm.chain.front().pem()});
  REQUIRE(got);
  const auto own = read_identity(arm.key.pem() + got->chain + got->site);
  REQUIRE(std::holds_alternative<own_identity>(own));
  CHECK(std::get<own_identity>(own).who() == arm.who());
  CHECK(std::get<own_identity>(own).chain.front().serial()
        != arm.chain.front().serial());
  for (const auto role : {site_role::coordinator, site_role::operating,
                          site_role::viewer, site_role::issuer})
    CHECK(code_of(bench.say<site_entered>(site_renewal{
              true, bench.site.issue(role, "x", "0c0d").chain.front().pem()}))
          == error_code::unauthorized);
  CHECK(code_of(bench.say<site_entered>(site_renewal{true, "nothing"}))
        == error_code::unauthorized);
  // For the list alone any certificate does.
  const auto anna = bench.site.issue(site_role::operating, "anna", "0e");
  CHECK(bench.say<site_entered>(site_renewal{false, anna.chain.front().pem()}));
}

TEST_CASE("a node with a token takes an identity when its session ends") {
  keeper_of_site bench{false, false};
  const auto asked = bench.say<identity_requested>(identity_request_query{});
  REQUIRE(asked);
  CHECK(asked->issuing.empty());
  const auto own = key_in_request(*from_hex(asked->request));
  REQUIRE(own);
  const auto made = make_certificate(
      {"hall", site_role::node, asked->node, asked->uuid}, own.get(),
      {bench.site.key, bench.site.mine}, clock_unix_s(), 1000);
  caf::anon_send(bench.keeper,
                 note_coordinator{"10.0.0.1:8420", "0f", true, 0});
  bench.settle();
  const auto set = bench.say<identity_set>(
      identity_setting{"", made.pem(), "", bench.site.mine.pem(), ""});
  REQUIRE(set);
  CHECK(set->later);
  CHECK(std::holds_alternative<own_identity>(
      read_identity_file(bench.config.file)));
  bench.advance(std::chrono::hours{1});
  CHECK(bench.started_anew == 0);
  caf::anon_send(bench.keeper, note_coordinator{"10.0.0.1:8420", "", false, 0});
  bench.settle();
  bench.advance(limits::site::answer);
  CHECK(bench.started_anew == 1);
}

TEST_CASE("an identity of other keys, of another name or role is not taken") {
  keeper_of_site bench{false, false};
  const auto asked = bench.say<identity_requested>(identity_request_query{});
  REQUIRE(asked);
  const auto own = key_in_request(*from_hex(asked->request));
  const auto set = [&](site_role role, const std::string& name, EVP_PKEY* of) {
    const auto made = make_certificate({"hall", role, name, "0a1b"}, of,
                                       {bench.site.key, bench.site.mine},
                                       clock_unix_s(), 1000);
    return bench.say<identity_set>(
        identity_setting{"", made.pem(), "", bench.site.mine.pem(), ""});
  };
  CHECK(code_of(set(site_role::node, "arm", bench.key.get()))
        == error_code::schema_violation);
  CHECK(code_of(set(site_role::node, "belt", own.get()))
        == error_code::schema_violation);
  CHECK(code_of(set(site_role::coordinator, "arm", own.get()))
        == error_code::schema_violation);
  CHECK_FALSE(std::filesystem::exists(bench.config.file));
  CHECK(set(site_role::node, "arm", own.get()));
}

TEST_CASE("a coordinator takes an identity once it has answered") {
  keeper_of_site bench{true, false};
  const auto asked = bench.say<identity_requested>(identity_request_query{});
  REQUIRE(asked);
  const auto certify = [&](site_role role, const std::string& request) {
    const auto of = key_in_request(*from_hex(request));
    return make_certificate({"hall", role, "head", "0a1b"}, of.get(),
                            {bench.site.key, bench.site.mine}, clock_unix_s(),
                            1000)
        .pem();
  };
  REQUIRE(bench.say<identity_set>(identity_setting{
      "", certify(site_role::coordinator, asked->request),
      certify(site_role::issuer, asked->issuing), bench.site.mine.pem(), ""}));
  CHECK(bench.started_anew == 0);
  bench.advance(limits::site::answer);
  CHECK(bench.started_anew == 1);
  const auto issuing = read_issuing(bench.config.file);
  CHECK(std::get<std::optional<own_identity>>(issuing).has_value());
}

TEST_CASE("a list of the revoked counts at once, and an older one never") {
  keeper_of_site bench;
  const auto arm = bench.site.issue(site_role::node, "arm", "0c0d");
  int ended = 0;
  bench.config.identity->watch(arm.chain.front(), [&ended] { ++ended; });
  const auto list = bench.list_without(arm.chain.front());
  const auto set = bench.say<revocations_set>(revocation_setting{"", list});
  REQUIRE(set);
  CHECK(set->number == 1);
  CHECK(set->revoked == 1);
  CHECK(ended == 1);
  CHECK(std::filesystem::exists(revoked_file_of(bench.config.file)));
  const auto older = bench.say<revocations_set>(revocation_setting{
      "", revocation_list{"hall"}.signed_text(bench.site.key)});
  REQUIRE(older);
  CHECK(older->number == 1);
  CHECK(code_of(bench.say<revocations_set>(revocation_setting{
            "", revocation_list{"hall"}.signed_text(site_of_today{}.key)}))
        == error_code::schema_violation);
}

TEST_CASE(
    "whom a coordinator has made identities for is known after a restart") {
  keeper_of_site bench;
  REQUIRE(bench.invite());
  REQUIRE(bench.enter("arm"));
  const auto belt = bench.site.issue(site_role::node, "belt", "0e");
  REQUIRE(
      bench.say<site_entered>(site_renewal{true, belt.chain.front().pem()}));
  bench.kill(bench.keeper);
  bench.start();
  const auto said = bench.say<actor_state>(state_query{});
  REQUIRE(said);
  CHECK(json::parse(said->json_text).at("issued")
        == json{{"0c0d", "arm"}, {"0e", "belt"}});
}

TEST_CASE("what a node is at its site can be asked") {
  keeper_of_site bench;
  REQUIRE(bench.invite("arm"));
  const auto said = bench.say<site_status>(site_query{});
  REQUIRE(said);
  CHECK(said->trust == "identity");
  CHECK(said->identity == "spiffe://hall/coordinator/head/0a1b");
  CHECK(said->issues);
  REQUIRE(said->invitations.size() == 1);
  CHECK(said->invitations.front().node == "arm");
  keeper_of_site with_token{true, false};
  CHECK(with_token.say<site_status>(site_query{})->trust == "token");
}
