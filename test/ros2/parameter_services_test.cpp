#include "cell_fixture.hpp"
#include "service_client.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/rcl_interfaces.hpp"
#include "skills/ros2/services/parameter_server.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <future>

using namespace roscell;
using namespace roscell::test;
using namespace roscell::ros2::rcl_interfaces;

namespace {

constexpr const char* declared = R"({
  "gain": {"type": "number", "minimum": 0, "maximum": 9, "changeable": true,
           "description": "How loud."},
  "word": {"type": "string", "values": ["a", "b"], "changeable": true}})";

constexpr const char* shown_values =
    R"({"gain": 2, "word": "a", "size": 4, "loop": true, "list": [1, 2.5],
        "body": {"a": 1}, "deep.er": "x"})";

ros2::parameter_answers known_answers() {
  ros2::parameter_answers result{declared, "use roscell set"};
  result.set(shown_values);
  return result;
}

template <class Reply, class Request>
Reply ask(const ros2::parameter_answers& whom,
          std::string (ros2::parameter_answers::*how)(std::string_view) const,
          const Request& request) {
  return ros2::deserialize<Reply>((whom.*how)(ros2::serialize(request)));
}

/// The parameters of a skill "teller" in a cell.
struct shown_skill {
  explicit shown_skill(const cell& home, bool may_be_set = false)
      : shared(std::make_shared<ros2::shared_participant>(
          lookup_in(home.environment("teller")))) {
    env.instance = "teller";
    env.changeable = declared;
    env.parameters = engine::parameters::parse(shown_values);
    env.ros2_set_parameters = may_be_set;
    server.emplace(env, shared, log.say(), [this](const std::string& changes) {
      log.say()("asked: " + changes);
      return request_number;
    });
    server->open(env.parameters);
  }

  engine::environment env;
  std::shared_ptr<ros2::shared_participant> shared;
  logbook log;
  std::int64_t request_number = 7; ///< Of the next one; 0: none can be made.
  std::optional<ros2::parameter_server> server;
};

parameter_value number_value(double x) {
  parameter_value result;
  result.type = parameter_type::PARAMETER_DOUBLE;
  result.double_value = x;
  return result;
}

parameter_value text_value(const std::string& x) {
  parameter_value result;
  result.type = parameter_type::PARAMETER_STRING;
  result.string_value = x;
  return result;
}

std::string request_of(std::vector<parameter> wanted) {
  return ros2::serialize(set_parameters_request{std::move(wanted)});
}

/// What became of each parameter; a reason, or "" where it was set.
std::vector<std::string> reasons_in(const std::string& reply) {
  std::vector<std::string> result;
  for (const auto& x :
       ros2::deserialize<set_parameters_response>(reply).results) {
    CHECK(x.successful == x.reason.empty());
    result.push_back(x.reason);
  }
  return result;
}

std::string reason_of_all(const std::string& reply) {
  return ros2::deserialize<set_parameters_atomically_response>(reply)
      .result.reason;
}

double gain_in(const std::string& reply) {
  if (reply.empty())
    return -1;
  const auto got = ros2::deserialize<get_parameters_response>(reply);
  return got.values.empty() ? -1 : got.values[0].double_value;
}

} // namespace

TEST_CASE("parameters are listed by their levels and prefixes") {
  const auto answers = known_answers();
  const auto list = [&](std::vector<std::string> prefixes,
                        std::uint64_t depth) {
    return ask<list_parameters_response>(
               answers, &ros2::parameter_answers::list,
               list_parameters_request{std::move(prefixes), depth})
        .result;
  };
  // An object has no type in ROS 2.
  CHECK(list({}, 0).names
        == std::vector<std::string>{"deep.er", "gain", "list", "loop", "size",
                                    "word"});
  CHECK(list({}, 0).prefixes == std::vector<std::string>{"deep"});
  CHECK(list({}, 1).names.size() == 5);
  CHECK(list({"deep"}, 0).names == std::vector<std::string>{"deep.er"});
  CHECK(list({"gain"}, 0).names == std::vector<std::string>{"gain"});
  CHECK(list({"ga"}, 0).names.empty());
}

TEST_CASE(
    "values have the types that are declared, and what is not there none") {
  const auto answers = known_answers();
  const names_request wanted{{"gain", "word", "size", "loop", "list", "none"}};
  const auto got = ask<get_parameters_response>(
                       answers, &ros2::parameter_answers::get, wanted)
                       .values;
  REQUIRE(got.size() == 6);
  CHECK(got[0].type == parameter_type::PARAMETER_DOUBLE);
  CHECK(got[0].double_value == 2);
  CHECK(got[1].string_value == "a");
  CHECK(got[2].integer_value == 4);
  CHECK(got[3].bool_value);
  CHECK(got[4].double_array_value == std::vector<double>{1, 2.5});
  CHECK(got[5].type == parameter_type::PARAMETER_NOT_SET);
  const auto types = ask<get_parameter_types_response>(
                         answers, &ros2::parameter_answers::types, wanted)
                         .types;
  for (std::size_t i = 0; i < got.size(); ++i)
    CHECK(types.at(i) == got[i].type);
}

TEST_CASE("a parameter is described with its range, and as read only or not") {
  const auto got = ask<describe_parameters_response>(
                       known_answers(), &ros2::parameter_answers::describe,
                       names_request{{"gain", "word", "size"}})
                       .descriptors;
  REQUIRE(got.size() == 3);
  CHECK(got[0].description == "How loud.");
  REQUIRE(got[0].floating_point_range.size() == 1);
  CHECK(got[0].floating_point_range[0].to_value == 9);
  CHECK_FALSE(got[0].read_only);
  CHECK(got[1].additional_constraints == R"(one of ["a","b"])");
  CHECK(got[2].read_only);
}

TEST_CASE("who wants to set a parameter by DDS is told how it is done") {
  const auto answers = known_answers();
  const set_parameters_request wanted{{{"gain", {}}, {"word", {}}}};
  const auto each = ask<set_parameters_response>(
      answers, &ros2::parameter_answers::refuse, wanted);
  REQUIRE(each.results.size() == 2);
  CHECK_FALSE(each.results[0].successful);
  CHECK(each.results[0].reason == "use roscell set");
  CHECK_FALSE(ask<set_parameters_atomically_response>(
                  answers, &ros2::parameter_answers::refuse_all, wanted)
                  .result.successful);
}

TEST_CASE("requests of unauthenticated peers for parameters cost no more than "
          "they may") {
  const auto answers = known_answers();
  CHECK_THROWS_AS(answers.get("nonsense"), ros2::cdr_error);
  CHECK_THROWS_AS(answers.list(""), ros2::cdr_error);
  const names_request many{std::vector<std::string>(5000, "gain")};
  CHECK(
      ask<get_parameters_response>(answers, &ros2::parameter_answers::get, many)
          .values.size()
      == ros2::parameter_answers::most_names);
}

TEST_CASE("a client of ROS 2 gets parameters, and what they are later") {
  use_sockets();
  cell home{0};
  shown_skill shown{home};
  service_client client{lookup_in(home.environment("client")), "teller",
                        "get_parameters", "GetParameters"};
  const auto request = ros2::serialize(names_request{{"gain"}});
  CHECK(gain_in(client.call(request)) == 2);
  shown.server->show(engine::parameters::parse(R"({"gain": 5})"));
  CHECK(gain_in(client.call(request)) == 5);
  // What cannot be read gets no reply, and the next request gets one.
  CHECK(client
            .call(std::string("\0\1\0\0\xff\xff\xff\xff", 8),
                  std::chrono::milliseconds{300})
            .empty());
  CHECK(shown.log.wait_for("a request to 'get_parameters' cannot be read"));
  CHECK(gain_in(client.call(request)) == 5);
}

TEST_CASE("parameters are shown at another address, too") {
  use_sockets();
  cell home{0};
  cell other{1};
  shown_skill shown{home};
  shown.server->suspend();
  shown.server->resume(other.environment("teller"));
  service_client client{lookup_in(other.environment("client")), "teller",
                        "get_parameters", "GetParameters"};
  CHECK(gain_in(client.call(ros2::serialize(names_request{{"gain"}}))) == 2);
}

TEST_CASE("of parameters that a client sets those that can be are one change") {
  const auto answers = known_answers();
  const auto some = request_of({{"gain", number_value(3.5)},
                                {"size", number_value(5)},
                                {"word", text_value("b")},
                                {"none", text_value("x")},
                                {"gain", {}}});
  const auto asked = answers.read_request(some, false);
  CHECK(asked.changes() == R"({"gain":3.5,"word":"b"})");
  CHECK(reasons_in(asked.reply(""))
        == std::vector<std::string>{"",
                                    "it cannot be changed while the skill runs",
                                    "", "there is no such parameter",
                                    "a value of this type cannot be set"});
  CHECK(reasons_in(asked.reply("too loud"))[0] == "too loud");
  // All or none of them.
  const auto none = answers.read_request(some, true);
  CHECK(none.changes().empty());
  CHECK(reason_of_all(none.reply(""))
        == "it cannot be changed while the skill runs");
  const auto all =
      answers.read_request(request_of({{"gain", number_value(3)}}), true);
  CHECK(all.changes() == R"({"gain":3.0})");
  CHECK(reason_of_all(all.reply("too loud")) == "too loud");
}

TEST_CASE("what JSON has no form of is no value that a client can set") {
  const auto answers = known_answers();
  for (const auto& x : {number_value(std::nan("")), number_value(HUGE_VAL),
                        text_value("\xff"), text_value("\xc3")}) {
    const auto asked = answers.read_request(request_of({{"gain", x}}), false);
    CHECK(asked.changes().empty());
    CHECK(reasons_in(asked.reply(""))[0]
          == "a value of this type cannot be set");
  }
  CHECK(answers.read_request(request_of({}), false).changes().empty());
  CHECK_THROWS_AS(answers.read_request("nonsense", false), ros2::cdr_error);
  const std::vector<parameter> many(5000, {"gain", number_value(1)});
  CHECK(
      reasons_in(answers.read_request(request_of(many), false).reply("")).size()
      == ros2::parameter_answers::most_names);
}

TEST_CASE("a client that sets parameters hears what the cell has said") {
  use_sockets();
  cell home{0};
  shown_skill shown{home, true};
  service_client client{lookup_in(home.environment("client")), "teller",
                        "set_parameters", "SetParameters"};
  std::ptrdiff_t times = 0;
  const auto set = [&](const std::string& answer) {
    auto reply = std::async(std::launch::async, [&] {
      return client.call(request_of({{"gain", number_value(3)}}));
    });
    CHECK(shown.log.wait_for(R"(asked: {"gain":3.0})", ++times));
    // That of another request is none.
    shown.server->on_answer(6, "late");
    shown.server->on_answer(7, answer);
    return reasons_in(reply.get())[0];
  };
  CHECK(set("").empty());
  CHECK(set("too loud") == "too loud");
}

TEST_CASE("while the cell is asked others are answered, and none asks more") {
  use_sockets();
  cell home{0};
  shown_skill shown{home, true};
  const auto place = lookup_in(home.environment("client"));
  service_client one{place, "teller", "set_parameters", "SetParameters"};
  service_client other{place, "teller", "set_parameters", "SetParameters"};
  service_client reader{place, "teller", "get_parameters", "GetParameters"};
  auto first = std::async(std::launch::async, [&] {
    return one.call(request_of({{"gain", number_value(3)}}));
  });
  CHECK(shown.log.wait_for("asked: "));
  CHECK(gain_in(reader.call(ros2::serialize(names_request{{"gain"}}))) == 2);
  CHECK(reasons_in(other.call(request_of({{"gain", number_value(4)}})))[0]
        == "another change is under way");
  CHECK(shown.log.lines().size() == 1);
  shown.server->on_answer(7, "");
  CHECK(reasons_in(first.get())[0].empty());
  // Where there is nobody to be asked that is said.
  shown.request_number = 0;
  CHECK_THAT(reasons_in(other.call(request_of({{"gain", number_value(4)}})))[0],
             Catch::Matchers::Contains("nobody is there to be asked"));
}

TEST_CASE("a skill at another address asks the cell again") {
  use_sockets();
  cell home{0};
  cell away{1};
  shown_skill shown{home, true};
  {
    service_client client{lookup_in(home.environment("client")), "teller",
                          "set_parameters", "SetParameters"};
    // Nobody answers this one: its client is in the former cell.
    auto lost = std::async(std::launch::async, [&] {
      return client.call(request_of({{"gain", number_value(3)}}),
                         std::chrono::milliseconds{500});
    });
    CHECK(shown.log.wait_for("asked: "));
    shown.server->suspend();
    CHECK(lost.get().empty());
  }
  shown.server->resume(away.environment("teller"));
  service_client client{lookup_in(away.environment("client")), "teller",
                        "set_parameters", "SetParameters"};
  auto reply = std::async(std::launch::async, [&] {
    return client.call(request_of({{"gain", number_value(3)}}));
  });
  CHECK(shown.log.wait_for("asked: ", 2));
  shown.server->on_answer(7, "");
  CHECK(reasons_in(reply.get())[0].empty());
}
