#include "actors/instances/ros2/ros2_program_start.hpp"

#include "actors/instances/ros2/ros_name.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/step_end.hpp"

#include <optional>
#include <utility>

namespace roscell {

namespace {

/// Finds the program by the ament index, as `ros2 run` and `ros2 launch` do,
/// and becomes it. Arguments: what it is, its package, its name, how many files
/// to source, those files, and its own arguments.
constexpr const char* start_script = R"(
fail() { echo "ros2_standalone: $*" >&2; exit 127; }
kind=$1 package=$2 name=$3 setups=$4 found=
shift 4
if (( setups == 0 )) && [[ -z ${AMENT_PREFIX_PATH:-} ]]; then
  for file in /opt/ros/*/setup.bash; do
    [[ -r $file ]] && source "$file"
  done
fi
for (( ; setups > 0; --setups )); do
  [[ -r $1 ]] || fail "there is no '$1' to source; correct \"setup\""
  source "$1"
  shift
done
if [[ $kind == launch ]]; then
  command -v ros2 > /dev/null || fail "there is no 'ros2' to launch '$name'"
  [[ $name != /* || -r $name ]] || fail "there is no launch file '$name'"
  [[ $name == /* ]] && exec ros2 launch "$name" "$@"
  exec ros2 launch "$package" "$name" "$@"
fi
if [[ $name == /* ]]; then
  path=$name
else
  IFS=: read -ra prefixes <<< "${AMENT_PREFIX_PATH:-}"
  for prefix in "${prefixes[@]}"; do
    [[ -e $prefix/share/ament_index/resource_index/packages/$package ]] \
      && { found=$prefix; break; }
  done
  [[ -n $found ]] \
    || fail "there is no package '$package' in AMENT_PREFIX_PATH" \
            "'${AMENT_PREFIX_PATH:-}'; correct \"package\", or name the" \
            "workspace's setup.bash in \"setup\""
  path=$found/lib/$package/$name
fi
[[ -x $path ]] || fail "there is no program '$path'"
exec "$path" "$@"
)";

using word_list = std::vector<std::string>;

/// Null: the step has not so many, or this is no end at all.
const io_endpoint* find_end(const instance_spec& spec,
                            const std::optional<step_end>& place) {
  if (!place)
    return nullptr;
  const auto& ends = place->is_input ? spec.input : spec.output;
  return place->number < ends.size() ? &ends[place->number] : nullptr;
}

/// The descriptor's, replaced by what model and step say.
json parameters_of(const ros2_program& program, const instance_spec& spec) {
  json result = json::object();
  for (const auto* text : {&program.parameters, &spec.parameters}) {
    const auto said = json::parse(*text, nullptr, false);
    if (said.is_object())
      result.update(said);
  }
  return result;
}

/// ROS 2 reads values as YAML, of which JSON is a part.
std::string value_text(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Launch files read text as it is.
std::string argument_text(const json& value) {
  return value.is_string() ? value.get<std::string>() : value_text(value);
}

failure no_such_end(const instance_spec& spec, const std::string& topic,
                    const std::string& place) {
  return {error_code::engine_failed,
          "the topic '" + topic + "' of its program stands for '" + place
              + "', which step '" + spec.step + "' has not",
          "",
          "give the step that end, or correct \"topics\" in its skill.json: "
          "input, output, or with its place, input:1"};
}

word_list ros_arguments(const ros2_program& program, const instance_spec& spec,
                        const std::string& enclave,
                        const std::map<std::string, std::string>& topics) {
  auto result = program.arguments;
  result.insert(result.end(),
                {"--ros-args", "-r", "__node:=" + ros_name(spec.step), "-r",
                 "__ns:=/" + ros_name(spec.task), "--enclave", enclave});
  for (const auto& [own, topic] : topics)
    result.insert(result.end(), {"-r", own + ":=" + topic});
  const auto parameters = parameters_of(program, spec);
  for (const auto& [name, value] : parameters.items())
    result.insert(result.end(), {"-p", name + ":=" + value_text(value)});
  return result;
}

word_list launch_arguments(const ros2_program& program,
                           const instance_spec& spec,
                           const std::map<std::string, std::string>& topics) {
  auto result = program.arguments;
  for (const auto& [name, topic] : topics)
    result.push_back(name + ":=" + topic);
  const auto parameters = parameters_of(program, spec);
  for (const auto& [name, value] : parameters.items())
    result.push_back(name + ":=" + argument_text(value));
  return result;
}

} // namespace

std::variant<ros2_start, failure> ros2_start_of(const ros2_program& program,
                                                const instance_spec& spec) {
  ros2_start result;
  result.endpoints.instance = spec.instance;
  std::map<std::string, std::string> topics;
  for (const auto& [own, place] : program.topics) {
    const auto which = parse_step_end(place);
    const auto* end = find_end(spec, which);
    if (end == nullptr)
      return no_such_end(spec, own, place);
    topics[own] = end->endpoint;
    auto& seen =
        which->is_input ? result.endpoints.read : result.endpoints.written;
    seen.push_back(end->endpoint);
  }
  // What every node of ROS 2 writes.
  if (topics.empty())
    result.endpoints.written = {"/rosout"};
  const bool launches = !program.launch.empty();
  const auto enclave = "/" + ros_name(spec.instance);
  if (!launches)
    result.endpoints.program = enclave;
  result.command = {"/bin/bash",
                    "-c",
                    start_script,
                    "ros2_standalone",
                    launches ? "launch" : "run",
                    program.package,
                    launches ? program.launch : program.executable,
                    std::to_string(program.setup.size())};
  const auto add = [&](const word_list& words) {
    result.command.insert(result.command.end(), words.begin(), words.end());
  };
  add(program.setup);
  add(launches ? launch_arguments(program, spec, topics)
               : ros_arguments(program, spec, enclave, topics));
  result.environment = {{"RMW_IMPLEMENTATION", "rmw_fastrtps_cpp"},
                        {"ROS_LOCALHOST_ONLY", "0"},
                        {"PYTHONUNBUFFERED", "1"}};
  return result;
}

} // namespace roscell
