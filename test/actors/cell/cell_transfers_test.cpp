#include "test/actors/fakes/coordinator_fakes.hpp"

namespace roscell::test {

namespace {

json release(const std::string& node, const std::string& instances) {
  return {{"type", "node_release"}, {"node", node}, {"instances", instances}};
}

/// Two members besides the coordination node; tasks go where their labels say.
struct leaving_node : paper_cell {
  fake_agent& arm = add("arm");
  fake_agent& leg = add("leg");

  /// A task whose one step is being deployed to the node.
  pending_reply deploy_slowly(const std::string& task, fake_agent& node) {
    node.mood = temper::slow;
    const auto result =
        post(echo_task(task, {echo_step("s", 1, node.identity.name)}));
    REQUIRE(reply_of(result) == nullptr);
    REQUIRE(node.deployments.size() == 1);
    return result;
  }

  void run(const std::string& task, const std::string& node) {
    const auto reply = request(echo_task(task, {echo_step("s", 1, node)}));
    REQUIRE(reply.at("type") == "task_accepted");
  }

  void come_back(fake_agent& x) {
    lose(x);
    ++x.identity.epoch;
    REQUIRE(enter(x));
  }
};

} // namespace

TEST_CASE_METHOD(leaving_node,
                 "A node that is being deployed to is not given away",
                 "[cell_transfers]") {
  const auto task = deploy_slowly("t", arm);
  const auto refused = request(release("arm", "refuse"));
  CHECK(error_of(refused) == "conflict");
  CHECK(refused.at("error").at("where") == "/instances");
  CHECK(row("arm").state == row_state::active);
  arm.finish_starting();
  time.settle();
  CHECK(reply_of(task).at("type") == "task_accepted");
}

TEST_CASE_METHOD(leaving_node,
                 "To terminate ends what is being deployed to a node too",
                 "[cell_transfers]") {
  const auto task = deploy_slowly("t", arm);
  const auto reply = request(release("arm", "terminate"));
  REQUIRE(reply.at("type") == "node_released");
  CHECK(reply.at("terminated") == json{"t"});
  CHECK(error_of(reply_of(task)) == "conflict");
  CHECK(tasks().empty());
}

TEST_CASE_METHOD(leaving_node,
                 "To reschedule moves what was being deployed to a node",
                 "[cell_transfers]") {
  const auto task = deploy_slowly("t", arm);
  const auto reply = post(release("arm", "reschedule"));
  CHECK(reply_of(reply) == nullptr);
  CHECK(arm.orders.empty());
  arm.finish_starting();
  time.settle();
  CHECK(reply_of(task).at("type") == "task_accepted");
  // Its step wants this node, so it stays.
  CHECK(error_of(reply_of(reply)) == "no_feasible_allocation");
  CHECK(row("arm").state == row_state::active);
  CHECK(arm.orders.empty());
}

TEST_CASE_METHOD(leaving_node,
                 "A transfer that has been answered goes no further",
                 "[cell_transfers]") {
  run("a", "arm");
  run("b", "arm");
  arm.slow_removals = true;
  const auto reply = post(release("arm", "terminate"));
  REQUIRE(arm.removals.size() == 1);
  come_back(arm);
  CHECK(error_of(reply_of(reply)) == "unreachable");
  CHECK(row("arm").state == row_state::active);
  arm.slow_removals = false;
  arm.finish_removals();
  time.settle();
  CHECK(arm.removals.size() == 1);
  // One of the two was ended already, as the answer says.
  CHECK(tasks().size() == 1);
  CHECK(reply_of(reply).at("error").at("message").dump().find("terminated")
        != std::string::npos);
  CHECK(arm.orders.empty());
  CHECK(count("transfer_ended") == 1);
}

TEST_CASE_METHOD(leaving_node, "A departing node has one transfer",
                 "[cell_transfers]") {
  run("a", "arm");
  arm.slow_removals = true;
  const auto first = post(release("arm", "terminate"));
  const auto second = request(release("arm", "terminate"));
  CHECK(error_of(second) == "conflict");
  CHECK(second.at("error").at("hint").dump().find("lab-3-1")
        != std::string::npos);
  arm.finish_removals();
  time.settle();
  CHECK(reply_of(first).at("type") == "node_released");
}

TEST_CASE_METHOD(leaving_node,
                 "A release that a full disk refuses is not begun",
                 "[cell_transfers]") {
  disk_full = true;
  CHECK(error_of(request(release("arm", "refuse"))) == "internal");
  CHECK(row("arm").state == row_state::active);
  CHECK(count("node_departing") == 0);
  CHECK(arm.orders.empty());
  disk_full = false;
  CHECK(request(release("arm", "refuse")).at("type") == "node_released");
}

TEST_CASE_METHOD(leaving_node, "Nothing is told before the transfer is kept",
                 "[cell_transfers]") {
  slow_disk = true;
  const auto reply = post(release("arm", "refuse"));
  CHECK(row("arm").state == row_state::active);
  CHECK(request({{"type", "transfer_query"}}).at("transfers").empty());
  slow_disk = false;
  finish_writes();
  time.settle();
  CHECK(reply_of(reply).at("type") == "node_released");
}

TEST_CASE_METHOD(leaving_node,
                 "A node that is away can be released, whatever it was doing",
                 "[cell_transfers]") {
  lose(arm);
  CHECK(request(release("arm", "refuse")).at("type") == "node_released");
  CHECK(row("arm").identity.uuid.empty());
}

} // namespace roscell::test
