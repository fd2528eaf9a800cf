#include "cell_fixture.hpp"

#include "roscell/ros2.hpp"
#include "roscell/ros2/cdr.hpp"

#include <fastrtps/xmlparser/XMLProfileManager.h>

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

std::unique_ptr<cell_server> must_open(std::uint8_t id, std::uint32_t domain) {
  cell_server_options options;
  options.address = "127.0.0.1";
  options.port = 0;
  options.server_id = id;
  options.domain_id = domain;
  options.announcement = "test";
  auto result = cell_server::open(options);
  if (auto* error = std::get_if<edge_error>(&result))
    FAIL(error->message);
  return std::get<0>(std::move(result));
}

} // namespace

void use_sockets() {
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery =
      eprosima::fastrtps::IntraprocessDeliveryType::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
}

engine::say_function logbook::say() {
  return [this](const std::string& line) {
    std::lock_guard guard{mutex_};
    lines_.push_back(line);
    grown_.notify_all();
  };
}

bool logbook::wait_for(const std::string& part, std::ptrdiff_t times) {
  auto has_it = [&] {
    return std::count_if(lines_.begin(), lines_.end(),
                         [&](const auto& line) {
                           return line.find(part) != std::string::npos;
                         })
           >= times;
  };
  std::unique_lock guard{mutex_};
  return grown_.wait_for(guard, patience, has_it);
}

std::vector<std::string> logbook::lines() const {
  std::lock_guard guard{mutex_};
  return lines_;
}

engine::variable_lookup lookup_in(variables values) {
  auto kept = std::make_shared<const variables>(std::move(values));
  return [kept](const char* name) -> const char* {
    auto found = kept->find(name);
    return found != kept->end() ? found->second.c_str() : nullptr;
  };
}

cell::cell(std::uint8_t server_id, std::uint32_t domain_id)
    : server_id_(server_id), domain_id_(domain_id),
      server_(must_open(server_id, domain_id)) {
  // nop
}

variables cell::environment(const std::string& instance) const {
  return {{"ROS_DOMAIN_ID", std::to_string(domain_id_)},
          {"ROS_DISCOVERY_SERVER", std::string(server_id_, ';')
                                       + "127.0.0.1:" + std::to_string(port())},
          {"ROSCELL_INSTANCE", instance}};
}

skill::skill(const variables& environment) {
  use_sockets();
  ros2::add_ros2_protocol(parts_, lookup_in(environment));
}

std::unique_ptr<engine::input_handler> skill::input(const std::string& topic,
                                                    const std::string& type) {
  return parts_.make_input(context(topic, type));
}

std::unique_ptr<engine::output_handler> skill::output(const std::string& topic,
                                                      const std::string& type) {
  auto result = parts_.make_output(context(topic, type));
  result->open();
  return result;
}

engine::stream_context skill::context(const std::string& topic,
                                      const std::string& type) {
  return {{"ros2", topic, type}, parameters_of(parameters), log.say()};
}

engine::frame frame_of(const std::string& type, std::string payload) {
  engine::frame result;
  result.data_type = type;
  result.payload = std::move(payload);
  return result;
}

engine::frame text_frame(const std::string& data) {
  return frame_of(text, ros2::serialize(ros2::std_msgs::string{data}));
}

std::string text_of(const std::optional<engine::frame>& x) {
  return x ? ros2::deserialize<ros2::std_msgs::string>(x->payload).data
           : "nothing";
}

void check_message(const cell& home) {
  skill reading{home.environment("reader")};
  skill writing{home.environment("writer")};
  running_input input{reading.input("/chatter", text)};
  auto output = writing.output("/chatter", text);
  output->write(text_frame("early"));
  REQUIRE(writing.log.wait_for("has come; now 1"));
  output->write(text_frame("hello"));
  CHECK(text_of(input.sink().wait_for(0)) == "hello");
}

} // namespace roscell::test
