#pragma once

#include "messages/codec/json_codec.hpp"

#include <cstdint>
#include <string>

/// Parameters of an instance that are changed while it runs.
namespace roscell {

/// Gives parameters of an instance other values, without a restart, and writes
/// them down in its task. Answered once the skill works with them.
struct parameter_change {
  static constexpr const char* type = "parameter_change";
  std::string instance;
  std::string parameters; ///< JSON object of those that change.

  static constexpr auto fields() {
    return field_list{required("instance", &parameter_change::instance),
                      raw_json("parameters", &parameter_change::parameters)};
  }
};

struct parameters_changed {
  static constexpr const char* type = "parameters_changed";
  std::string instance;
  std::string task;
  std::string step;
  std::string node;
  std::string former;     ///< JSON object of what these were before.
  std::string parameters; ///< JSON object of all that it has now.

  static constexpr auto fields() {
    return field_list{required("instance", &parameters_changed::instance),
                      required("task", &parameters_changed::task),
                      required("step", &parameters_changed::step),
                      required("node", &parameters_changed::node),
                      raw_json("former", &parameters_changed::former),
                      raw_json("parameters", &parameters_changed::parameters)};
  }
};

/// Coordinator to node: an instance is to work with these from now on, also
/// where it is started again.
struct set_parameters {
  static constexpr const char* type = "set_parameters";
  std::string instance;
  std::string parameters; ///< JSON object, all of them.

  static constexpr auto fields() {
    return field_list{required("instance", &set_parameters::instance),
                      raw_json("parameters", &set_parameters::parameters)};
  }
};

struct parameters_set {
  static constexpr const char* type = "parameters_set";
  std::string instance;

  static constexpr auto fields() {
    return field_list{required("instance", &parameters_set::instance)};
  }
};

} // namespace roscell
