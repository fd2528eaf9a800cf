#include "actors/instances/ros2/ros2_program.hpp"

#include "messages/codec/json_codec.hpp"
#include "messages/step_end.hpp"
#include "messages/stream_protocols.hpp"
#include "schemas/parameters/declared_parameter.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace roscell {

std::string ros_name(std::string_view text) {
  std::string result{text};
  std::replace_if(
      result.begin(), result.end(),
      [](char c) {
        return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
                 || (c >= '0' && c <= '9') || c == '_');
      },
      '_');
  const bool begins_badly =
      result.empty() || (result[0] >= '0' && result[0] <= '9');
  return begins_badly ? "_" + result : result;
}

namespace {

std::vector<std::string> topics_of(const std::vector<io_endpoint>& ends) {
  std::vector<std::string> result;
  for (const auto& x : ends)
    if (x.protocol == protocols::ros2)
      result.push_back(x.endpoint);
  return result;
}

} // namespace

std::optional<watch_endpoints>
engine_ends(const instance_spec& spec,
            const std::vector<stream_count>& frames) {
  watch_endpoints result{spec.instance, ros_name(spec.instance),
                         topics_of(spec.output), topics_of(spec.input)};
  if (frames.empty() || (result.written.empty() && result.read.empty()))
    return std::nullopt;
  return result;
}

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

/// The first of the values that no ROS 2 program can be given, with the reason.
std::optional<failure> refused_parameter(const json& values, ros_reader reader,
                                         const instance_spec& spec) {
  const auto errors = ros_errors(values, reader, "");
  if (errors.empty())
    return std::nullopt;
  return failure{error_code::engine_failed,
                 "step '" + spec.step
                     + "' has a parameter that its program "
                       "cannot be given: "
                     + errors.front().pointer + ": " + errors.front().expected,
                 "", "correct it in the request or in the skill.json"};
}

const declared_parameter* find_declared(const declared_parameters& known,
                                        const std::string& name) {
  const auto i = known.find(name);
  return i == known.end() ? nullptr : &i->second;
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

/// The step's stand behind the skill's, so that of two the step's counts.
word_list own_arguments(const ros2_program& program,
                        const instance_spec& spec) {
  auto result = program.arguments;
  result.insert(result.end(), spec.arguments.begin(), spec.arguments.end());
  return result;
}

word_list ros_arguments(const ros2_program& program, const instance_spec& spec,
                        const std::string& enclave,
                        const std::map<std::string, std::string>& topics,
                        const declared_parameters& declared) {
  auto result = own_arguments(program, spec);
  result.insert(result.end(),
                {"--ros-args", "-r", "__node:=" + ros_name(spec.step), "-r",
                 "__ns:=/" + ros_name(spec.task), "--enclave", enclave});
  for (const auto& [own, topic] : topics)
    result.insert(result.end(), {"-r", own + ":=" + topic});
  const auto parameters = parameters_of(program, spec);
  for (const auto& [name, value] : parameters.items())
    result.insert(result.end(),
                  {"-p", name + ":="
                             + ros_text(value, find_declared(declared, name),
                                        ros_reader::program)});
  return result;
}

word_list launch_arguments(const ros2_program& program,
                           const instance_spec& spec,
                           const std::map<std::string, std::string>& topics,
                           const declared_parameters& declared) {
  auto result = own_arguments(program, spec);
  for (const auto& [name, topic] : topics)
    result.push_back(name + ":=" + topic);
  const auto parameters = parameters_of(program, spec);
  for (const auto& [name, value] : parameters.items())
    result.push_back(name + ":="
                     + ros_text(value, find_declared(declared, name),
                                ros_reader::launch_file));
  return result;
}

} // namespace

std::variant<ros2_start, failure>
ros2_start_of(const ros2_program& program, const instance_spec& spec,
              const declared_parameters& declared) {
  const auto reader =
      program.launch.empty() ? ros_reader::program : ros_reader::launch_file;
  if (auto why = refused_parameter(parameters_of(program, spec), reader, spec))
    return std::move(*why);
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
  add(launches ? launch_arguments(program, spec, topics, declared)
               : ros_arguments(program, spec, enclave, topics, declared));
  result.environment = {{"RMW_IMPLEMENTATION", "rmw_fastrtps_cpp"},
                        {"ROS_LOCALHOST_ONLY", "0"},
                        {"PYTHONUNBUFFERED", "1"}};
  return result;
}

std::variant<ros2_start, failure> ros2_start_of(const skill_descriptor& skill,
                                                const instance_spec& spec) {
  declared_parameters declared;
  for (const auto& model : skill.models)
    if (model.name == spec.model && !model.parameters.empty())
      declared = read_parameters(json::parse(model.parameters));
  return ros2_start_of(skill.ros2.front(), spec, declared);
}

} // namespace roscell
