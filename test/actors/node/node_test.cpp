#include "actors/node/node.hpp"

#include "messages/failure.hpp"
#include "test/fixture.hpp"

namespace roscell::test {

namespace {

/// Notes that no more requests are taken.
struct closable_server : http_server {
  bool& closed;

  explicit closable_server(bool& flag) : closed(flag) {
    // nop
  }

  uint16_t port() const override {
    return 0;
  }

  void accept_sessions(session_acceptor) override {
    // Nobody comes.
  }

  void stop(std::function<void()>) override {
    closed = true;
  }
};

/// A node of three parts that do nothing, a router and a membership that
/// leaves its cell when told to.
struct node_fixture {
  virtual_time time;
  node_parts parts;
  bool closed = false;
  std::optional<caf::error> end;
  std::optional<caf::error> router_end;
  std::vector<caf::response_promise> leaving;
  std::function<void()> leave; ///< Lets the membership answer.
  node_actor actor;

  node_fixture() {
    parts.context = time.context;
    parts.services = std::make_shared<node_services>();
    parts.edges = std::make_shared<node_edges>();
    parts.edges->sockets.http = std::make_unique<closable_server>(closed);
    for (int i = 0; i < 3; ++i)
      parts.children.push_back(make_part());
    const auto router = make_part();
    router->attach_functor([this](const caf::error& why) { router_end = why; });
    parts.router = caf::actor_cast<request_router_actor>(router);
    parts.children.push_back(router);
  }

  ~node_fixture() {
    leaving.clear();
    for (const auto& child : parts.children)
      time.kill(child);
  }

  node_fixture(const node_fixture&) = delete;
  node_fixture& operator=(const node_fixture&) = delete;

  caf::actor make_part() {
    return time.system.spawn(
        [] { return caf::behavior{[](caf::get_atom) {}}; });
  }

  void add_membership() {
    const auto member = time.system.spawn([this](caf::event_based_actor* self) {
      return caf::behavior{[this, self](const leave_cell&) {
                             leaving.push_back(self->make_response_promise());
                           },
                           [this](caf::ok_atom) {
                             for (auto& promise : leaving)
                               promise.deliver(node_departed{});
                           }};
    });
    leave = [member] { caf::anon_send(member, caf::ok_atom::value); };
    parts.services->membership = caf::actor_cast<membership_actor>(member);
    parts.children.push_back(member);
  }

  void start() {
    actor = spawn(time.system, time.context, node, parts);
    actor->attach_functor([this](const caf::error& why) { end = why; });
    time.settle();
  }

  void stop() {
    caf::anon_send(actor, stop_node{});
    time.settle();
  }
};

} // namespace

TEST_CASE_METHOD(node_fixture,
                 "A part that dies takes the node and all its parts along",
                 "[node]") {
  start();
  size_t ended = 0;
  for (const auto& child : parts.children)
    child->attach_functor([&ended] { ++ended; });
  CHECK_FALSE(end);
  time.kill(parts.children[1]);
  CHECK(ended == 4);
  REQUIRE(end);
  CHECK(to_failure(*end).code == error_code::internal);
}

TEST_CASE_METHOD(node_fixture, "A node stops with all its parts", "[node]") {
  start();
  stop();
  CHECK(closed);
  REQUIRE(end);
  CHECK_FALSE(*end);
}

TEST_CASE_METHOD(node_fixture,
                 "A node that stops tells its requests before it leaves",
                 "[node]") {
  add_membership();
  start();
  stop();
  CHECK(closed);
  CHECK(router_end);
  CHECK_FALSE(end);
  REQUIRE(leaving.size() == 1);
  leave();
  time.settle();
  REQUIRE(end);
  CHECK_FALSE(*end);
}

TEST_CASE_METHOD(node_fixture,
                 "A node that is to be made anew does not leave its cell",
                 "[node]") {
  add_membership();
  start();
  caf::anon_send_exit(actor, caf::exit_reason::user_shutdown);
  time.settle();
  CHECK(leaving.empty());
  CHECK(closed);
  CHECK(router_end);
  REQUIRE(end);
  CHECK_FALSE(*end);
}

} // namespace roscell::test
