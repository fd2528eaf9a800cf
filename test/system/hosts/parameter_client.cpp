#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/rcl_interfaces.hpp"
#include "test/ros2/service_client.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <iostream>
#include <string>

/// `ros2 param set` as rclpy on rmw_fastrtps_cpp does it, in the cell that the
/// environment names. Prints what the service has answered.
/// Usage: parameter_client NODE NAME VALUE, the value as JSON: a text, a number
/// or a truth value.
namespace {

using namespace roscell::ros2::rcl_interfaces;
using type_word = parameter_type;

parameter_value value_of(const nlohmann::json& x) {
  parameter_value result;
  if (x.is_string()) {
    result.type = type_word::PARAMETER_STRING;
    result.string_value = x.get<std::string>();
  } else if (x.is_boolean()) {
    result.type = type_word::PARAMETER_BOOL;
    result.bool_value = x.get<bool>();
  } else if (x.is_number_integer()) {
    result.type = type_word::PARAMETER_INTEGER;
    result.integer_value = x.get<std::int64_t>();
  } else {
    result.type = type_word::PARAMETER_DOUBLE;
    result.double_value = x.get<double>();
  }
  return result;
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: parameter_client NODE NAME VALUE\n";
    return 2;
  }
  roscell::test::service_client client{
      [](const char* name) { return std::getenv(name); }, argv[1],
      "set_parameters", "SetParameters"};
  set_parameters_request request;
  request.parameters.push_back(
      {argv[2], value_of(nlohmann::json::parse(argv[3]))});
  const auto text = client.call(roscell::ros2::serialize(request));
  if (text.empty()) {
    std::cout << "no answer\n";
    return 1;
  }
  const auto reply =
      roscell::ros2::deserialize<set_parameters_response>(text).results.at(0);
  std::cout << (reply.successful ? "Set parameter successful"
                                 : "Setting parameter failed: " + reply.reason)
            << "\n";
  return reply.successful ? 0 : 1;
}
