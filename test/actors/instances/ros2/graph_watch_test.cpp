#include "actors/instances/ros2/graph_watch.hpp"

#include "test/actors/fakes/supervision_fakes.hpp"

using namespace roscell;
using namespace roscell::test;

namespace {

using words = std::vector<std::string>;

endpoint_guid guid(std::uint8_t who, std::uint8_t number) {
  endpoint_guid result{};
  result[0] = who;
  result[15] = number;
  return result;
}

graph_endpoint image(bool writes) {
  return {"rt/image", "sensor_msgs::msg::dds_::Image_",
          writes,     true,
          "volatile", ""};
}

/// A watch between a graph and somebody who wants a writer and a reader.
struct watch_bench : virtual_time {
  watch_bench() {
    graph->begin_service();
    watch = roscell::spawn(system, context, graph_watch, graph);
  }

  ~watch_bench() {
    kill(watch);
  }

  /// Sends `request` and keeps what is told.
  caf::actor ask(const watch_endpoints& request) {
    auto reported_to = &reported;
    auto result = system.spawn(
        [=, to = watch](caf::event_based_actor* self) -> caf::behavior {
          self->send(to, request);
          return {[=](const endpoints_missing& x) {
            reported_to->push_back(x.missing);
          }};
        });
    settle();
    return result;
  }

  std::shared_ptr<ros_graph> graph = std::make_shared<ros_graph>();
  graph_watch_actor watch;
  std::vector<words> reported;
};

} // namespace

TEST_CASE_METHOD(watch_bench, "what a program lacks is told at once and when "
                              "it changes") {
  const auto who = ask({"i", "/i", {"/image"}, {"/image"}});
  REQUIRE(reported.size() == 1);
  CHECK(reported[0] == words{"a writer of /image", "a reader of /image"});
  graph->name_participant({1}, "/i");
  graph->add(guid(1, 1), image(true));
  settle();
  REQUIRE(reported.size() == 2);
  CHECK(reported[1] == words{"a reader of /image"});
  graph->add(guid(1, 2), image(false));
  settle();
  CHECK(reported.back().empty());
  graph->remove(guid(1, 1));
  settle();
  CHECK(reported.back() == words{"a writer of /image"});
  caf::anon_send_exit(who, caf::exit_reason::kill);
}

TEST_CASE_METHOD(watch_bench, "ends of other programs count only where any "
                              "will do") {
  graph->name_participant({2}, "/");
  graph->add(guid(2, 1), image(true));
  const auto strict = ask({"i", "/i", {"/image"}, {}});
  CHECK(reported.back() == words{"a writer of /image"});
  const auto any = ask({"j", "", {"/image"}, {}});
  CHECK(reported.back().empty());
  caf::anon_send_exit(strict, caf::exit_reason::kill);
  caf::anon_send_exit(any, caf::exit_reason::kill);
}

TEST_CASE_METHOD(watch_bench, "who has ended is forgotten") {
  const auto who = ask({"i", "/i", {"/image"}, {}});
  caf::anon_send_exit(who, caf::exit_reason::kill);
  settle();
  graph->name_participant({1}, "/i");
  graph->add(guid(1, 1), image(true));
  settle();
  CHECK(reported.size() == 1);
}

TEST_CASE_METHOD(watch_bench, "without a server nobody is missing, with one "
                              "again those who do not come") {
  graph->end_service();
  settle();
  const auto who = ask({"i", "/i", {"/image"}, {}});
  CHECK(reported.empty());
  graph->begin_service();
  settle();
  CHECK(reported == std::vector<words>{{"a writer of /image"}});
  graph->name_participant({1}, "/i");
  graph->add(guid(1, 1), image(true));
  settle();
  CHECK(reported.back().empty());
  graph->end_service();
  settle();
  CHECK(reported.size() == 2);
  graph->begin_service();
  settle();
  CHECK(reported.back() == words{"a writer of /image"});
  caf::anon_send_exit(who, caf::exit_reason::kill);
}
