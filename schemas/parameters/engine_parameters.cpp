#include "schemas/parameters/declared_parameter.hpp"

#include "schemas/text_excerpt.hpp"

#include <string_view>

namespace roscell {

namespace {

/// What the engines for executors and actors (skills/engine) understand
/// whatever the model, under ""; what those for executors do, under "executor";
/// and what protocols do, under their names. In the form of a descriptor.
constexpr const char* primitive_engine = R"({
  "": {
    "queue_length": {
      "type": "integer", "default": 8, "minimum": 1, "maximum": 65536,
      "description": "Frames of one input that may wait; a live input then drops its oldest, a file is held back."
    },
    "queue_mib": {
      "type": "integer", "default": 64, "minimum": 1, "maximum": 65536,
      "unit": "MiB", "description": "Their size together."
    }
  },
  "executor": {
    "max_failures": {
      "type": "integer", "default": 10, "minimum": 1, "maximum": 1000000000,
      "description": "Frames in a row that may fail before the skill does."
    }
  },
  "file": {
    "follow": {
      "type": "boolean", "default": true,
      "description": "Wait for more lines and files; else the skill ends when all is processed."
    },
    "max_frame_mib": {
      "type": "integer", "default": 64, "minimum": 1, "maximum": 65536,
      "unit": "MiB", "description": "A larger frame of a file is skipped."
    }
  },
  "file video": {
    "loop": {
      "type": "boolean", "default": false,
      "description": "Begin again after the last file or at the end of a film."
    },
    "rate_hz": {
      "type": "number", "default": 0, "minimum": 0, "maximum": 1000000,
      "unit": "Hz", "description": "Most frames per second of an input; 0 is no limit."
    }
  },
  "ros2": {
    "ros2_reliability": {
      "type": "string", "values": ["reliable", "best_effort"],
      "description": "Whether what was lost is sent again; by the type if absent."
    },
    "ros2_durability": {
      "type": "string", "values": ["volatile", "transient_local"],
      "description": "Whether a late reader gets the last messages; by the type if absent."
    },
    "ros2_depth": {
      "type": "integer", "minimum": 1, "maximum": 1000,
      "description": "How many messages are kept; by the type if absent."
    },
    "ros2_gid_bytes": {
      "type": "integer", "default": 24, "values": [24, 16], "unit": "bytes",
      "description": "24 for the ROS graph of Humble, 16 for Iron and later."
    }
  },
  "video": {
    "encoding": {
      "type": "string", "default": "mono8", "values": ["mono8", "bgr8"],
      "description": "Of the pictures."
    },
    "frame_id": {
      "type": "string", "default": "camera",
      "description": "Frame that the pictures are taken in."
    }
  }
})";

/// Whether a protocol is among names with blanks between them.
bool is_among(const std::string& protocol, const std::string& names) {
  return (" " + names + " ").find(" " + protocol + " ") != std::string::npos;
}

void add_parameters(const json& engine, const std::string& protocol,
                    declared_parameters& to) {
  for (const auto& [names, parameters] : engine.items())
    if (protocol.empty() ? names.empty() : is_among(protocol, names))
      to = read_parameters(parameters, to);
}

std::string unknown_parameter_text(const declared_parameters& known,
                                   const std::string& name) {
  std::vector<std::string_view> names;
  for (const auto& [each, x] : known)
    names.emplace_back(each);
  return unknown_name_text("parameter", name, names);
}

} // namespace

declared_parameters parameters_of(const skill_descriptor& skill,
                                  const implementation_model& model) {
  declared_parameters result;
  if (skill.engine == "primitive" || skill.engine == "actor") {
    static const auto engine = json::parse(primitive_engine);
    add_parameters(engine, "", result);
    // What an actor throws ends it.
    if (skill.engine == "primitive")
      add_parameters(engine, "executor", result);
    for (const auto* port : {&skill.input, &skill.output})
      for (const auto& protocol : port->protocols)
        add_parameters(engine, protocol, result);
  }
  if (model.parameters.empty())
    return result;
  return read_parameters(json::parse(model.parameters), result);
}

std::vector<schema_error> parameter_errors(const declared_parameters& known,
                                           const json& given,
                                           const std::string& place) {
  std::vector<schema_error> result;
  for (const auto& [name, value] : given.items()) {
    const auto at = (json::json_pointer{place} / name).to_string();
    const auto declared = known.find(name);
    if (declared == known.end())
      result.push_back({at, unknown_parameter_text(known, name)});
    else if (auto problem = value_problem(declared->second, value);
             !problem.empty())
      result.push_back({at, std::move(problem)});
  }
  return result;
}

} // namespace roscell
