#include "test/actors/fakes/cell_fakes.hpp"

namespace {

using namespace roscell;
using namespace roscell::test;

/// A member whose session has a test at its other end.
struct member_test : cell_fixture {
  wire_ptr link;
  member_actor it;
  std::vector<session_envelope> heard;
  std::vector<heartbeat_kind> heartbeats;
  std::string closed;
  caf::actor peer;

  member_test() {
    site.start_coordinator();
    link = make_wire(time.system, site.context, site.random, site.faults);
    caf::anon_send(site.base.actor,
                   session_admitted{link->ends[0], node.identity});
    peer = time.system.spawn([this](caf::event_based_actor*) -> caf::behavior {
      return {
          [this](const frame_received& x) {
            heard.push_back(*read_envelope(x.text));
          },
          [this](const heartbeat_received& x) { heartbeats.push_back(x.kind); },
          [this](const session_closed& x) { closed = x.reason; },
      };
    });
    caf::anon_send(link->ends[1],
                   own_session{caf::actor_cast<session_owner_actor>(peer)});
    site.pass(0s);
    it = site.base.members.at(0);
  }

  ~member_test() {
    time.kill(peer);
  }

  void say(std::string text) {
    caf::anon_send(link->ends[1], send_frame{std::move(text)});
    site.pass(0s);
  }

  void request(uint64_t id, const json& body) {
    say(write_envelope(envelope_kind::request, id, body));
  }

  void notice(const json& body) {
    say(write_envelope(envelope_kind::notice, 0, body));
  }

  void heartbeat(heartbeat_kind kind) {
    caf::anon_send(link->ends[1], send_heartbeat{kind});
    site.pass(0s);
  }

  json registration() const {
    node_registration x;
    x.identity = node.identity;
    x.incarnation = 1;
    x.resources = some_resources("arm-1");
    return message_json(x);
  }

  error_code last_refusal() const {
    return failure_from(heard.back().body).code;
  }
};

TEST_CASE_METHOD(member_test, "a registration becomes a row") {
  request(1, registration());
  REQUIRE(heard.size() == 1);
  CHECK(heard[0].id == 1);
  CHECK(heard[0].body["type"] == "node_registered");
  CHECK(site.base.rows.at("arm-1").member == it);
}

TEST_CASE_METHOD(member_test, "starts for which the answer has no room follow "
                              "it") {
  for (int i = 0; i < 12; ++i) {
    auto spec = some_spec("t-a-" + std::to_string(i), "t");
    spec.parameters = R"({"x":")" + std::string(100'000, 'y') + "\"}";
    site.base.verdicts.push_back({spec.instance, verdict::start, {spec}});
  }
  request(1, registration());
  REQUIRE(heard.size() > 1);
  CHECK(heard[0].body["type"] == "node_registered");
  const auto in_answer = heard[0].body["verdicts"].size();
  CHECK(in_answer + heard.size() - 1 == 12);
  for (size_t i = 1; i < heard.size(); ++i)
    CHECK(heard[i].body["type"] == "instance_deployment");
  CHECK(closed.empty());
}

TEST_CASE_METHOD(member_test, "a registration that comes twice is answered "
                              "twice and done once") {
  request(1, registration());
  request(1, registration());
  REQUIRE(heard.size() == 2);
  CHECK(heard[0].body == heard[1].body);
  request(2, registration());
  CHECK(last_refusal() == error_code::conflict);
  CHECK(closed.empty());
}

TEST_CASE_METHOD(member_test, "a node cannot register as another one") {
  auto body = registration();
  SECTION("by name") {
    body["identity"]["name"] = "arm-2";
  }
  SECTION("by UUID") {
    body["identity"]["uuid"] = "b-2";
  }
  SECTION("by epoch") {
    body["identity"]["epoch"] = 7;
  }
  request(1, body);
  REQUIRE(heard.size() == 1);
  CHECK(last_refusal() == error_code::unauthorized);
  CHECK_FALSE(closed.empty());
  CHECK(site.base.rows.empty());
}

TEST_CASE_METHOD(member_test, "what a node says of its name is not believed") {
  auto body = registration();
  body["resources"]["name"] = "arm-2";
  body["instances"] = json::array({some_row("t-a-1", "t")});
  body["instances"][0]["node"] = "arm-2";
  request(1, body);
  const auto& said = site.base.rows.at("arm-1").registration;
  CHECK(said.resources.name == "arm-1");
  CHECK(said.instances.at(0).node == "arm-1");
  auto row = some_row("t-a-1", "t");
  row.node = "arm-2";
  notice(message_json(instance_changed{row}));
  REQUIRE(site.base.changes.size() == 1);
  CHECK(site.base.changes[0].instance.node == "arm-1");
}

TEST_CASE_METHOD(member_test, "a refused registration is told and ends the "
                              "session") {
  site.base.refusal = {error_code::conflict, "the name is taken", "", "pick"};
  request(1, registration());
  REQUIRE(heard.size() == 1);
  CHECK(failure_from(heard[0].body) == *site.base.refusal);
  CHECK(closed == "the name is taken");
}

TEST_CASE_METHOD(member_test, "a session without a registration ends after "
                              "15 s") {
  for (auto i = 0; i < 14; ++i) {
    site.pass(1s);
    heartbeat(heartbeat_kind::heartbeat);
  }
  CHECK(closed.empty());
  site.pass(1s);
  CHECK(closed == "it did not register in time");
  CHECK(site.base.losses.empty());
}

TEST_CASE_METHOD(member_test, "the first request must be a registration") {
  request(1, message_json(node_departure{"bye"}));
  CHECK(last_refusal() == error_code::conflict);
  CHECK_FALSE(closed.empty());
}

TEST_CASE_METHOD(member_test, "nothing is told of a node that has not "
                              "registered") {
  notice(message_json(instance_changed{some_row("t-a-1", "t")}));
  notice(message_json(skills_changed{}));
  CHECK(site.base.changes.empty());
  CHECK(site.base.skills.empty());
  auto reply = time.ask<resource_report>(it, resource_query{});
  site.pass(0s);
  CHECK(to_failure((*reply)->error()).code == error_code::unreachable);
}

TEST_CASE_METHOD(member_test, "an image is for the node whose session it is") {
  const auto request_of_another =
      message_json(image_request{"debian:1", "amd64", "arm-2", {}});
  request(1, registration());
  request(2, request_of_another);
  REQUIRE(heard.size() == 2);
  CHECK(heard[1].body["type"] == "image_offered");
  REQUIRE(site.base.image_requests.size() == 1);
  CHECK(site.base.image_requests[0].node == "arm-1");
}

TEST_CASE_METHOD(member_test, "heartbeats are acked and keep a member alive") {
  request(1, registration());
  for (auto i = 0; i < 10; ++i) {
    site.pass(4s);
    heartbeat(heartbeat_kind::heartbeat);
  }
  CHECK(closed.empty());
  CHECK(heartbeats == std::vector<heartbeat_kind>(10, heartbeat_kind::ack));
}

TEST_CASE_METHOD(member_test, "a silent member is asked and then lost within a "
                              "lease") {
  request(1, registration());
  site.pass(4200ms);
  CHECK(heartbeats.empty());
  site.pass(3700ms);
  CHECK(heartbeats.size() > 10);
  CHECK(heartbeats[0] == heartbeat_kind::probe);
  CHECK(closed.empty());
  site.pass(100ms);
  CHECK(closed == "no heartbeat for 8 s");
  REQUIRE(site.base.losses.size() == 1);
  CHECK(site.base.losses[0]
        == member_lost{"a-1", it, "no heartbeat for 8 s", 8000});
}

TEST_CASE_METHOD(member_test, "a broken connection loses the member at once") {
  request(1, registration());
  cut(*link);
  site.pass(0s);
  REQUIRE(site.base.losses.size() == 1);
  CHECK(site.base.losses[0].reason == "the connection broke");
}

TEST_CASE_METHOD(member_test, "a node that departs is not lost") {
  request(1, registration());
  request(2, message_json(node_departure{"bye"}));
  CHECK(heard.back().body["type"] == "node_departed");
  CHECK(site.base.rows.empty());
  cut(*link);
  site.pass(0s);
  CHECK(site.base.losses.empty());
}

TEST_CASE_METHOD(member_test, "the third bad frame ends the session") {
  request(1, registration());
  say("{]");
  request(2, {{"type", "task_request"}});
  CHECK(last_refusal() == error_code::schema_violation);
  CHECK(closed.empty());
  say(std::string(100'000, '['));
  CHECK(closed == "it sent frames that make no sense");
  REQUIRE(site.base.losses.size() == 1);
}

TEST_CASE_METHOD(member_test, "a member may not ask what is not its business") {
  request(1, registration());
  request(2, message_json(resource_query{}));
  CHECK(last_refusal() == error_code::unknown_type);
  CHECK(closed.empty());
}

TEST_CASE_METHOD(member_test, "the coordinator's death ends its sessions") {
  request(1, registration());
  time.kill(site.base.actor);
  site.pass(0s);
  CHECK(closed == "the coordinator has stopped");
}

TEST_CASE_METHOD(member_test, "a member closes its session when told") {
  request(1, registration());
  caf::anon_send(it, close_session{"it has registered again"});
  site.pass(0s);
  CHECK(closed == "it has registered again");
}

TEST_CASE_METHOD(member_test, "a member's frames are taken from its session "
                              "only") {
  caf::anon_send(it, frame_received{write_envelope(envelope_kind::request, 1,
                                                   registration())});
  site.pass(0s);
  CHECK(site.base.rows.empty());
}

TEST_CASE_METHOD(member_test, "a question that the node does not answer times "
                              "out") {
  request(1, registration());
  auto reply = time.ask<resource_report>(it, resource_query{});
  for (auto i = 0; i < 5; ++i) {
    site.pass(1s);
    heartbeat(heartbeat_kind::heartbeat);
  }
  CHECK_FALSE(*reply);
  site.pass(1s);
  REQUIRE(*reply);
  CHECK(to_failure((*reply)->error()).code == error_code::timeout);
}

TEST_CASE_METHOD(member_test, "a log that is followed may take longer") {
  request(1, registration());
  auto reply = time.ask<log_excerpt>(it, log_query{"t-a-1", -1, 0, 9'000'000});
  for (auto i = 0; i < 29; ++i) {
    site.pass(1s);
    heartbeat(heartbeat_kind::heartbeat);
  }
  CHECK_FALSE(*reply);
  site.pass(1s);
  CHECK(*reply);
}

} // namespace
