#include "actors/node/node.hpp"

#include "messages/failure.hpp"
#include "test/fixture.hpp"

namespace roscell::test {

namespace {

/// A node of three parts that do nothing.
struct node_fixture {
  virtual_time time;
  node_parts parts;
  std::optional<caf::error> end;
  node_actor actor;

  node_fixture() {
    parts.context = time.context;
    parts.services = std::make_shared<node_services>();
    for (int i = 0; i < 3; ++i)
      parts.children.push_back(time.system.spawn(
          [] { return caf::behavior{[](caf::get_atom) {}}; }));
    actor = spawn(time.system, time.context, node, parts);
    actor->attach_functor([this](const caf::error& why) { end = why; });
    time.settle();
  }
};

} // namespace

TEST_CASE_METHOD(node_fixture,
                 "A part that dies takes the node and all its parts along",
                 "[node]") {
  size_t ended = 0;
  for (const auto& child : parts.children)
    child->attach_functor([&ended] { ++ended; });
  CHECK_FALSE(end);
  time.kill(parts.children[1]);
  CHECK(ended == 3);
  REQUIRE(end);
  CHECK(to_failure(*end).code == error_code::internal);
}

} // namespace roscell::test
