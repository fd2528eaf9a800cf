#pragma once

#include "skills/ros2/services/parameter_request.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace roscell::ros2 {

/// What the parameter services of a ROS 2 node answer, from message to message.
/// Pure. A request may come from anybody: each throws cdr_error for what is
/// none, and of many names the first thousand are answered.
class parameter_answers {
public:
  static constexpr std::size_t most_names = 1000;

  /// @param declared JSON object of the parameters that can be changed, each as
  /// its descriptor declares it.
  /// @param remedy what is said to who wants to change one.
  parameter_answers(const std::string& declared, std::string remedy);

  /// What there is now, a JSON object. What ROS 2 has no type for, such as an
  /// object, is left out.
  void set(const std::string& values);

  /// rcl_interfaces/srv/ListParameters, GetParameters, GetParameterTypes and
  /// DescribeParameters. A parameter that there is not is one that is not set.
  std::string list(std::string_view request) const;
  std::string get(std::string_view request) const;
  std::string types(std::string_view request) const;
  std::string describe(std::string_view request) const;

  /// SetParameters and SetParametersAtomically are refused: by DDS nobody
  /// proves who he is, so a cell lets them in only where it was set up so.
  std::string refuse(std::string_view request) const;
  std::string refuse_all(std::string_view request) const;
  /// What one of them asks of the cell, where it does.
  parameter_request read_request(std::string_view request,
                                 bool all_or_none) const {
    return {request, all_or_none, declared_, values_};
  }

private:
  const nlohmann::json declared_;
  const std::string remedy_;
  nlohmann::json values_ = nlohmann::json::object();
};

/// A service that each ROS 2 node with parameters has.
struct parameter_service {
  const char* name;     ///< Behind the node's: "get_parameters".
  const char* request;  ///< DDS name of its type.
  const char* response; ///< The same.
  std::string (parameter_answers::*answer)(std::string_view) const;
  enum { reads, sets, sets_all } kind;
};

const std::vector<parameter_service>& parameter_services();

} // namespace roscell::ros2
