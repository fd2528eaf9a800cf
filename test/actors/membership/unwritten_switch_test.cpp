#include "test/actors/fakes/cell_fakes.hpp"

#include "actors/session/registration_client.hpp"
#include "messages/failure.hpp"

/// A node that is told to go elsewhere, and cannot write that down.
namespace {

using namespace roscell;
using namespace roscell::test;

struct unwritten_switch_test : cell_fixture {
  /// Starts to switch the node by the REST API.
  auto begin_switch() {
    const status_question question{"nonce-of-the-asker"};
    auto asked = site.time.ask<registration_challenge>(
        node.membership,
        registration_query{question.nonce, prove(question, site_token)});
    site.time.settle();
    const auto challenge = asked->value();
    registration_switch order;
    order.transfer = "transfer-1";
    order.node = challenge->node;
    order.uuid = challenge->uuid;
    order.epoch = challenge->epoch;
    order.target = {{"cell-9", "base-9", "10.0.0.9:8420", "10.0.0.9:11811"}};
    order.nonce = challenge->nonce;
    order.proof = prove(order_of(order), site_token);
    auto reply = site.time.ask<switch_accepted>(node.membership, order);
    site.time.settle();
    return reply;
  }

  void fail_to_switch() {
    node.disk_full = true;
    const auto reply = begin_switch();
    REQUIRE(*reply);
    REQUIRE_FALSE(reply->value());
    REQUIRE(to_failure(reply->value().error()).message == "the disk is full");
  }

  std::string phase() {
    auto reply = site.time.ask<actor_state>(node.membership, state_query{});
    site.time.settle();
    return json::parse((*reply)->value().json_text).at("phase");
  }
};

} // namespace

TEST_CASE_METHOD(unwritten_switch_test,
                 "a node that rests goes on resting where its switch cannot be "
                 "written down") {
  site.start(node);
  fail_to_switch();
  CHECK(phase() == "resting");
  CHECK(state() == node_state::independent);
  site.pass(60s);
  CHECK(phase() == "resting");
  // It was not to be seen before, either.
  CHECK(node.announcements == 0);
  CHECK(node.searches == 0);
}

TEST_CASE_METHOD(unwritten_switch_test,
                 "a node that was looking for its cell goes on at once where "
                 "its switch cannot be written down") {
  site.start(node);
  site.join(node);
  site.pass(1s);
  const auto before = node.searches;
  fail_to_switch();
  site.pass(1ms);
  CHECK(phase() == "searching");
  CHECK(node.searches == before + 1);
  node.disk_full = false;
  site.start_coordinator();
  site.pass(40s);
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(unwritten_switch_test,
                 "a node that waits for a place still takes one that appears "
                 "where its switch cannot be written down") {
  site.start(node);
  caf::anon_send(node.membership, seek_cell{});
  site.pass(1s);
  REQUIRE(phase() == "resting");
  fail_to_switch();
  CHECK(phase() == "resting");
  CHECK(state() == node_state::independent);
}
