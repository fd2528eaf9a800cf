#include "schemas/checks/descriptor_checks.hpp"

#include "messages/step_end.hpp"
#include "schemas/parameters/declared_parameter.hpp"
#include "schemas/text_excerpt.hpp"

#include <set>
#include <string>

namespace roscell::checks {

namespace {

void check_volume(error_list& errors, const place& volume) {
  auto text = volume.text();
  auto mode = text.size() > 3 ? text.rfind(":ro") : std::string::npos;
  if (mode != std::string::npos && mode == text.size() - 3)
    text.erase(mode);
  auto colon = text.find(':');
  if (colon == std::string::npos)
    return;
  auto host = text.substr(0, colon);
  auto container = text.substr(colon + 1);
  auto fine = container.find(':') == std::string::npos && !climbs(host)
              && !climbs(container) && container.size() > 1;
  if (!fine)
    refuse(errors, volume,
           "/host/path:/container/path or /host/path:/container/path:ro, "
           "without '..'");
}

void check_entry_point(error_list& errors, const place& words) {
  auto programs = words.items();
  if (programs.empty())
    return;
  auto path = programs.front().text();
  if (!path.empty()
      && (path.front() == '/' || path.back() == '/' || climbs(path)))
    refuse(errors, programs.front(),
           "the program to be a path below the skill's folder, without '..'");
}

void check_topics(error_list& errors, const place& topics) {
  if (!topics.value.is_object())
    return;
  for (const auto& [name, end] : topics.value.items())
    if (end.is_string() && !parse_step_end(end.get<std::string>()))
      refuse(errors, {end, topics.at / name},
             "an end of the step: input, output, or with its place, input:1");
}

/// An actor is part of a program that runs already.
void check_actor_skill(error_list& errors, const place& skill) {
  if (!(skill / "entry_point").value.is_null())
    refuse(errors, skill / "entry_point",
           "no program: the one that embeds the node has the actor");
}

void check_folder_skill(error_list& errors, const place& skill) {
  if ((skill / "entry_point").value.is_null())
    refuse(errors, skill / "entry_point",
           "the program below the folder, and its arguments");
}

void check_base_images(error_list& errors, const place& skill) {
  for (const auto& model : (skill / "models").items())
    for (const auto& deployment : (model / "deployments").items())
      if (deployment.value.is_object()
          && (deployment / "base_image").value.is_null())
        refuse(errors, deployment / "base_image",
               "the image that a container of it is made from");
}

/// What a ROS 2 program cannot be given is told before a step is to start it.
void check_ros_values(error_list& errors, const place& skill) {
  const auto program = skill / "ros2";
  const auto reader = (program / "launch").value.is_null()
                          ? ros_reader::program
                          : ros_reader::launch_file;
  if (const auto said = program / "parameters"; said.value.is_object())
    append(errors, ros_errors(said.value, reader, said.at.to_string()));
  for (const auto& model : (skill / "models").items()) {
    const auto declared = model / "parameters";
    if (!declared.value.is_object())
      continue;
    for (const auto& [name, x] : declared.value.items()) {
      const auto at = declared.at / name;
      const auto by_default = x.is_object() ? at / "default" : at;
      const auto value = x.is_object() ? x.value("default", json{}) : x;
      if (value.is_null())
        continue;
      if (auto problem = ros_problem(value, reader); !problem.empty())
        errors.push_back(
            {by_default.to_string(), problem + ", got " + shown_value(value)});
    }
  }
}

/// Who runs a ROS 2 program says which; anybody else brings a program along.
void check_program(error_list& errors, const place& skill) {
  if (!skill.value.is_object())
    return;
  const auto engine = (skill / "engine").text();
  const auto program = skill / "ros2";
  check_topics(errors, program / "topics");
  if (engine != "actor")
    check_base_images(errors, skill);
  if (engine != "ros2_standalone") {
    if (engine == "actor")
      check_actor_skill(errors, skill);
    else
      check_folder_skill(errors, skill);
    if (!program.value.is_null())
      refuse(errors, program,
             "no ROS 2 program without \"engine\": "
             "\"ros2_standalone\"");
    return;
  }
  check_ros_values(errors, skill);
  const auto executable = program / "executable";
  const auto launch = program / "launch";
  const auto& said = launch.value.is_null() ? executable : launch;
  if (!(skill / "entry_point").value.is_null())
    refuse(errors, skill / "entry_point",
           "no program of the folder: \"ros2\" names the one that is run");
  if (executable.value.is_null() == launch.value.is_null())
    refuse(errors, executable, "either an executable or a launch file");
  else if (said.text().rfind('/', 0) != 0
           && (program / "package").value.is_null())
    refuse(errors, program / "package",
           "the package of " + said.text() + ", or an absolute path there");
}

/// Only what is real time has priorities.
void check_scheduling(error_list& errors, const place& request) {
  if (!request.value.is_object())
    return;
  const auto policy = (request / "policy").text();
  const auto real_time = policy == "fifo" || policy == "rr";
  const auto priority = request / "priority";
  if (real_time && priority.value.is_null())
    refuse(errors, priority,
           "a priority from 1 to 99, which " + policy + " needs");
  if (!real_time && !priority.value.is_null())
    refuse(errors, priority, "no priority without the policy fifo or rr");
}

} // namespace

void check_descriptor(error_list& errors, const place& skill) {
  check_entry_point(errors, skill / "entry_point");
  check_unique(errors, skill / "models", "name",
               "a name that no other model has");
  for (const auto& model : (skill / "models").items()) {
    if (const auto declared = model / "parameters"; declared.value.is_object())
      append(errors,
             declaration_errors(declared.value, declared.at.to_string()));
    auto deployments = model / "deployments";
    check_unique(errors, deployments, "name",
                 "a name that no other deployment of the model has");
    for (const auto& deployment : deployments.items()) {
      check_devices(errors, deployment / "devices");
      check_scheduling(errors, deployment / "scheduling");
      for (const auto& volume : (deployment / "volumes").items())
        check_volume(errors, volume);
    }
  }
}

void check_written_descriptor(error_list& errors, const place& skill) {
  check_program(errors, skill);
  check_descriptor(errors, skill);
}

void refuse(error_list& errors, const place& x, const std::string& expected) {
  errors.push_back({x.at.to_string(), x.value.is_null()
                                          ? absence_text(x.at.back(), expected)
                                          : "expected " + expected + ", got "
                                                + shown_value(x.value)});
}

void append(error_list& errors, const error_list& others) {
  errors.insert(errors.end(), others.begin(), others.end());
}

void check_unique(error_list& errors, const place& list, const char* member,
                  const std::string& what) {
  std::set<json> seen;
  for (const auto& item : list.items()) {
    auto id = item / member;
    if (!id.value.is_null() && !seen.insert(id.value).second)
      refuse(errors, id, what);
  }
}

bool climbs(const std::string& path) {
  return ("/" + path + "/").find("/../") != std::string::npos;
}

void check_absolute(error_list& errors, const place& x,
                    const std::string& what) {
  auto path = x.text();
  if (!path.empty() && (path.front() != '/' || climbs(path)))
    refuse(errors, x, what + " to be an absolute path without '..'");
}

void check_devices(error_list& errors, const place& list) {
  for (const auto& device : list.items())
    check_absolute(errors, device, "the device");
}

} // namespace roscell::checks
