#include "cell_fixture.hpp"

#include "roscell/ros2/std_msgs.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>

/// What a cell's discovery server knows of programs on a member's host, whose
/// server it meets and loses.
using namespace roscell;
using namespace roscell::test;

namespace {

constexpr std::uint8_t cell_id = 1;
constexpr std::uint8_t member_id = 2;

cell_server_options local(std::uint8_t id) {
  cell_server_options result;
  result.address = "127.0.0.1";
  result.port = 0;
  result.server_id = id;
  result.announcement = "test";
  return result;
}

std::unique_ptr<cell_server> opened(const cell_server_options& options,
                                    on_sighting callback = {}) {
  use_sockets();
  auto result = cell_server::open(options, std::move(callback));
  if (auto* error = std::get_if<edge_error>(&result))
    FAIL(error->message);
  return std::get<0>(std::move(result));
}

/// Counts how often participants are told of, by their names.
class reported_names {
public:
  void add(const std::string& name) {
    std::lock_guard guard{mutex_};
    ++counts_[name];
    changed_.notify_all();
  }

  std::size_t count(const std::string& name) {
    std::lock_guard guard{mutex_};
    return counts_[name];
  }

  bool wait_for_more_than(std::size_t before, const std::string& name) {
    std::unique_lock guard{mutex_};
    return changed_.wait_for(guard, patience,
                             [&] { return counts_[name] > before; });
  }

private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, std::size_t> counts_;
};

/// Waits for topics to be known, or not to be known any more.
class topic_watch {
public:
  explicit topic_watch(std::shared_ptr<ros_graph> graph)
      : graph_(std::move(graph)) {
    graph_->watch([this] {
      std::lock_guard guard{mutex_};
      news_ = true;
      changed_.notify_all();
    });
  }

  bool wait_for(const std::string& topic, bool known = true) {
    const auto end = std::chrono::steady_clock::now() + patience;
    for (;;) {
      if (knows(topic) == known)
        return true;
      std::unique_lock guard{mutex_};
      if (!changed_.wait_until(guard, end,
                               [this] { return std::exchange(news_, false); }))
        return false;
    }
  }

  bool knows(const std::string& topic) {
    const auto ends = graph_->endpoints();
    return std::any_of(ends.begin(), ends.end(),
                       [&](const auto& x) { return x.topic == topic; });
  }

private:
  const std::shared_ptr<ros_graph> graph_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool news_ = false;
};

/// A program with one topic, on the host of that server.
class program {
public:
  program(std::uint8_t id, const cell_server& server, const std::string& topic)
      : skill_({{"ROS_DOMAIN_ID", "0"},
                {"ROS_DISCOVERY_SERVER", std::string(id, ';') + "127.0.0.1:"
                                             + std::to_string(server.port())},
                {"ROSCELL_INSTANCE", "of." + topic.substr(1)}}),
        output_(skill_.output(topic, ros2::std_msgs::string::type_name)) {}

private:
  skill skill_;
  std::unique_ptr<engine::output_handler> output_;
};

struct two_servers {
  reported_names reported;
  std::unique_ptr<cell_server> cell = opened(
      local(cell_id), [this](const sighting& x) { reported.add(x.name); });
  topic_watch seen{cell->graph()};
  std::unique_ptr<cell_server> member;

  two_servers() {
    auto options = local(member_id);
    options.remote = remote_server{"127.0.0.1", cell->port(), cell_id};
    member = opened(options);
    meet();
  }

  void meet() {
    cell->meet(member_id);
    member->meet(cell_id);
  }

  void part() {
    cell->lose(member_id);
    member->lose(cell_id);
  }

  void end_doubt() {
    cell->end_doubt(member_id);
  }

  std::unique_ptr<program> there(const std::string& topic) {
    return std::make_unique<program>(member_id, *member, topic);
  }
};

} // namespace

TEST_CASE("servers that met again tell each other what came meanwhile") {
  two_servers x;
  const auto a = x.there("/a");
  REQUIRE(x.seen.wait_for("/a"));
  x.part();
  const auto b = x.there("/b");
  x.meet();
  CHECK(x.seen.wait_for("/b"));
  CHECK(x.seen.knows("/a"));
}

TEST_CASE("who ended while servers were parted is forgotten once the doubt is "
          "over, and nobody else") {
  two_servers x;
  auto a = x.there("/a");
  const auto b = x.there("/b");
  REQUIRE(x.seen.wait_for("/a"));
  REQUIRE(x.seen.wait_for("/b"));
  x.part();
  a.reset();
  const auto c = x.there("/c");
  topic_watch seen_there{x.member->graph()};
  REQUIRE(seen_there.wait_for("/c"));
  const auto before = x.reported.count("of_b");
  REQUIRE(before > 0);
  x.meet();
  REQUIRE(x.seen.wait_for("/c"));
  REQUIRE(x.reported.wait_for_more_than(before, "of_b"));
  CHECK(x.seen.knows("/a"));
  x.end_doubt();
  CHECK(x.seen.wait_for("/a", false));
  CHECK(x.seen.knows("/b"));
  CHECK(x.seen.knows("/c"));
}

TEST_CASE("all that a server has told of goes with its node, and nothing "
          "else") {
  two_servers x;
  const auto a = x.there("/a");
  const program own{cell_id, *x.cell, "/own"};
  REQUIRE(x.seen.wait_for("/a"));
  REQUIRE(x.seen.wait_for("/own"));
  x.cell->forget(member_id);
  CHECK(x.seen.wait_for("/a", false));
  CHECK(x.seen.knows("/own"));
  x.meet();
  CHECK(x.seen.wait_for("/a"));
}

TEST_CASE("a member's server that is made anew is known by what it says in its "
          "new life") {
  auto numbers = std::make_shared<number_reserve>();
  two_servers x;
  const auto a = x.there("/a");
  REQUIRE(x.seen.wait_for("/a"));
  auto options = local(member_id);
  options.port = x.member->port();
  options.remote = remote_server{"127.0.0.1", x.cell->port(), cell_id};
  options.numbers = numbers;
  x.part();
  x.member.reset();
  x.member = opened(options);
  x.meet();
  const auto b = x.there("/b");
  CHECK(x.seen.wait_for("/b"));
  CHECK(x.seen.wait_for("/a"));
}
