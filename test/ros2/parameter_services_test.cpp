#include "cell_fixture.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/rcl_interfaces.hpp"
#include "skills/ros2/services/parameter_server.hpp"

#include <catch2/catch.hpp>

#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/rtps/common/WriteParams.h>

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

/// A client as rmw_fastrtps makes one: the request names the reader.
class service_client : private ros2::dds::DataReaderListener,
                       private ros2::dds::DataWriterListener {
public:
  service_client(const cell& home, const std::string& node,
                 const std::string& service, const std::string& type)
      : shared_(lookup_in(home.environment("client"))),
        participant_(shared_.get(engine::parameters{})) {
    const auto dds_type = "rcl_interfaces::srv::dds_::" + type;
    replies_ =
        participant_->add_named_reader("rr/" + node + "/" + service + "Reply",
                                       dds_type + "_Response_", {}, this);
    requests_ =
        participant_->add_named_writer("rq/" + node + "/" + service + "Request",
                                       dds_type + "_Request_", {}, this);
  }

  ~service_client() override {
    participant_->remove(requests_);
    participant_->remove(replies_);
  }

  /// The reply that names the request; empty: none has come.
  std::string call(std::string request,
                   std::chrono::milliseconds limit = patience) {
    std::unique_lock guard{mutex_};
    if (!changed_.wait_for(guard, patience,
                           [this] { return writers_ > 0 && readers_ > 0; }))
      return {};
    eprosima::fastrtps::rtps::WriteParams sent;
    sent.related_sample_identity().writer_guid(replies_->guid());
    guard.unlock();
    requests_->write(&request, sent);
    guard.lock();
    const auto number = sent.sample_identity().sequence_number();
    if (!changed_.wait_for(guard, limit, [&] {
          return answer_to_ == number && !answer_.empty();
        }))
      return {};
    return answer_;
  }

private:
  void on_data_available(ros2::dds::DataReader* reader) override {
    std::string payload;
    ros2::dds::SampleInfo info;
    const std::lock_guard guard{mutex_};
    while (reader->take_next_sample(&payload, &info)
           == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      const auto& to = info.related_sample_identity;
      if (!info.valid_data || to.writer_guid() != replies_->guid())
        continue;
      answer_ = payload;
      answer_to_ = to.sequence_number();
    }
    changed_.notify_all();
  }

  void on_subscription_matched(
      ros2::dds::DataReader*,
      const ros2::dds::SubscriptionMatchedStatus& status) override {
    const std::lock_guard guard{mutex_};
    writers_ = status.current_count;
    changed_.notify_all();
  }

  void on_publication_matched(
      ros2::dds::DataWriter*,
      const ros2::dds::PublicationMatchedStatus& status) override {
    const std::lock_guard guard{mutex_};
    readers_ = status.current_count;
    changed_.notify_all();
  }

  ros2::shared_participant shared_;
  std::shared_ptr<ros2::participant> participant_;
  ros2::dds::DataReader* replies_ = nullptr;
  ros2::dds::DataWriter* requests_ = nullptr;
  std::mutex mutex_;
  std::condition_variable changed_;
  int writers_ = 0;
  int readers_ = 0;
  std::string answer_;
  eprosima::fastrtps::rtps::SequenceNumber_t answer_to_;
};

/// The parameters of a skill "teller" in a cell.
struct shown_skill {
  explicit shown_skill(const cell& home)
      : shared(std::make_shared<ros2::shared_participant>(
          lookup_in(home.environment("teller")))) {
    env.instance = "teller";
    env.changeable = declared;
    env.parameters = engine::parameters::parse(shown_values);
    server.emplace(env, shared, log.say());
    server->open(env.parameters);
  }

  engine::environment env;
  std::shared_ptr<ros2::shared_participant> shared;
  logbook log;
  std::optional<ros2::parameter_server> server;
};

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
  service_client client{home, "teller", "get_parameters", "GetParameters"};
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
  service_client client{other, "teller", "get_parameters", "GetParameters"};
  CHECK(gain_in(client.call(ros2::serialize(names_request{{"gain"}}))) == 2);
}
