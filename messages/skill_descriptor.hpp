#pragma once

#include "messages/resources.hpp"

#include <map>
#include <string>
#include <vector>

/// The launcher's half of a skill: what `skill.json` says. Plain types, so that
/// a skill or a tool can use them without an actor system.
namespace roscell {

struct port_description {
  std::vector<std::string> data_types; ///< "sensor_msgs/msg/Image", MIME types.
  std::vector<std::string> protocols;  ///< "ros2", "file", "video".

  static constexpr auto fields() {
    return field_list{required("data_types", &port_description::data_types),
                      required("protocols", &port_description::protocols)};
  }
};

/// One way to run a model.
struct deployment_option {
  std::string name;
  std::string base_image;
  std::vector<std::string> architectures; ///< Never empty.
  resource_request resources;
  std::vector<std::string> devices; ///< Device nodes the host must have.
  std::map<std::string, std::string> labels; ///< Labels the node must have.
  std::map<std::string, std::string> environment;
  std::vector<std::string> volumes; ///< "/host/path:/container/path[:ro]".

  static constexpr auto fields() {
    return field_list{
        required("name", &deployment_option::name),
        required("base_image", &deployment_option::base_image),
        required("architectures", &deployment_option::architectures),
        required("resources", &deployment_option::resources),
        optional("devices", &deployment_option::devices),
        optional("labels", &deployment_option::labels),
        optional("environment", &deployment_option::environment),
        optional("volumes", &deployment_option::volumes)};
  }
};

/// One way to do the operation.
struct implementation_model {
  std::string name;
  std::string parameters; ///< JSON object, may be empty.
  std::vector<deployment_option> deployments;

  static constexpr auto fields() {
    return field_list{
        required("name", &implementation_model::name),
        raw_json("parameters", &implementation_model::parameters),
        required("deployments", &implementation_model::deployments)};
  }
};

/// JSON form: schemas/skill_descriptor.schema.json.
struct skill_descriptor {
  std::string operation;
  std::string version; ///< Raised by the author; empty: see installed_skill.
  std::string engine;  ///< "primitive".
  std::vector<std::string>
      entry_point; ///< Program below the folder, arguments.
  port_description input;
  port_description output;
  std::vector<implementation_model> models;

  static constexpr auto fields() {
    return field_list{required("operation", &skill_descriptor::operation),
                      optional("version", &skill_descriptor::version),
                      required("engine", &skill_descriptor::engine),
                      required("entry_point", &skill_descriptor::entry_point),
                      required("input", &skill_descriptor::input),
                      required("output", &skill_descriptor::output),
                      required("models", &skill_descriptor::models)};
  }
};

} // namespace roscell
