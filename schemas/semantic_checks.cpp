#include "schemas/semantic_checks.hpp"

#include "messages/step_end.hpp"
#include "schemas/parameters/declared_parameter.hpp"
#include "schemas/text_excerpt.hpp"

#include <array>
#include <set>
#include <string>
#include <utility>

namespace roscell {

namespace {

using pointer = json::json_pointer;
using error_list = std::vector<schema_error>;

/// A value and where it stands in the document.
struct place {
  const json& value;
  pointer at;

  /// Its member or null, which has no members in turn.
  place operator/(const char* name) const {
    static const json none;
    auto i = value.is_object() ? value.find(name) : value.end();
    auto found = value.is_object() && i != value.end();
    return {found ? *i : none, at / name};
  }

  std::vector<place> items() const {
    std::vector<place> result;
    if (value.is_array())
      for (size_t i = 0; i < value.size(); ++i)
        result.push_back({value[i], at / i});
    return result;
  }

  /// Its text; empty if it is no string.
  std::string text() const {
    return value.is_string() ? value.get<std::string>() : std::string{};
  }
};

void refuse(error_list& errors, const place& x, const std::string& expected) {
  auto got = x.value.is_null() ? std::string{"but it is missing"}
                               : "got " + value_words(x.value);
  errors.push_back({x.at.to_string(), "expected " + expected + ", " + got});
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

void check_members(error_list& errors, const place& formation) {
  std::set<json> seen;
  for (const auto& name : (formation / "members").items())
    if (!seen.insert(name.value).second)
      refuse(errors, name, "a name that is not in the list already");
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

void check_resources(error_list& errors, const place& node) {
  check_unique(errors, node / "gpus", "index",
               "an index that no other GPU of the node has");
  check_devices(errors, node / "devices");
}

/// On paper a GPU without memory is a slip; a real node may fail to tell.
void check_gpu_memory(error_list& errors, const place& node) {
  if ((node / "unified_memory").value != json(false))
    return;
  for (const auto& gpu : (node / "gpus").items())
    if (gpu.value.is_object() && (gpu / "memory_mib").value.is_null())
      refuse(errors, gpu / "memory_mib",
             "the memory of the GPU, for the node has no unified memory");
}

void check_endpoints(error_list& errors, const place& ends) {
  if (ends.value.is_object() && (ends / "protocol").text() == "file")
    check_absolute(errors, ends / "endpoint", "the endpoint of a file");
  for (const auto& end : ends.items())
    if (end.value.is_object())
      check_endpoints(errors, end);
}

/// A step of a request, or the specification of an instance.
void check_streams(error_list& errors, const place& x) {
  check_endpoints(errors, x / "input");
  check_endpoints(errors, x / "output");
}

void check_pipeline(error_list& errors, const place& request) {
  auto steps = request / "pipeline";
  check_unique(errors, steps, "id", "an id that no other step has");
  for (const auto& step : steps.items())
    check_streams(errors, step);
}

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
void check_scheduling(error_list& errors, const place& wish) {
  if (!wish.value.is_object())
    return;
  const auto policy = (wish / "policy").text();
  const auto real_time = policy == "fifo" || policy == "rr";
  const auto priority = wish / "priority";
  if (real_time && priority.value.is_null())
    refuse(errors, priority,
           "a priority from 1 to 99, which " + policy + " needs");
  if (!real_time && !priority.value.is_null())
    refuse(errors, priority, "no priority without the policy fifo or rr");
}

void append(error_list& errors, const error_list& others) {
  errors.insert(errors.end(), others.begin(), others.end());
}

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

/// As an author writes it. What a member registers has been looked at when it
/// read the file.
void check_written_descriptor(error_list& errors, const place& skill) {
  check_program(errors, skill);
  check_descriptor(errors, skill);
}

void check_plan_document(error_list& errors, const place& plan) {
  check_unique(errors, plan / "nodes", "name", "a name that no other node has");
  for (const auto& node : (plan / "nodes").items()) {
    check_resources(errors, node);
    check_gpu_memory(errors, node);
  }
  for (const auto& skill : (plan / "skills").items())
    check_written_descriptor(errors, skill);
  check_pipeline(errors, plan / "request");
}

/// Nodes to be thought of are as those of a plan on paper.
void check_plan_query(error_list& errors, const place& query) {
  check_pipeline(errors, query);
  check_unique(errors, query / "with", "name", "a name that no other node has");
  for (const auto& node : (query / "with").items()) {
    check_resources(errors, node);
    check_gpu_memory(errors, node);
  }
}

void check_reservation(error_list& errors, const place& x) {
  for (const auto& spec : (x / "specs").items())
    check_streams(errors, spec);
}

void check_registration(error_list& errors, const place& x) {
  check_resources(errors, x / "resources");
  for (const auto& skill : (x / "skills").items())
    check_descriptor(errors, skill / "descriptor");
  std::set<std::string> seen;
  for (const auto& row : (x / "instances").items()) {
    auto id = row / "spec" / "instance";
    if (!id.text().empty() && !seen.insert(id.text()).second)
      refuse(errors, id, "an id that no other instance has");
    check_streams(errors, row / "spec");
  }
}

void check_reported_resources(error_list& errors, const place& x) {
  check_resources(errors, x / "resources");
}

void check_deployment(error_list& errors, const place& x) {
  check_streams(errors, x / "spec");
}

void check_verdicts(error_list& errors, const place& x) {
  for (const auto& verdict : (x / "verdicts").items()) {
    auto spec = verdict / "spec";
    if ((verdict / "verdict").text() == "start" && spec.value.empty())
      refuse(errors, spec, "what to start");
    check_streams(errors, spec);
    for (const auto& one : spec.items())
      check_streams(errors, one);
  }
}

using check = void (*)(error_list&, const place&);

constexpr std::array<std::pair<std::string_view, check>, 10> checks{{
    {"cell_formation", check_members},
    {"instance_deployment", check_deployment},
    {"instance_reservation", check_reservation},
    {"node_registered", check_verdicts},
    {"node_registration", check_registration},
    {"plan_document", check_plan_document},
    {"resource_report", check_reported_resources},
    {"skill_descriptor", check_written_descriptor},
    {"task_plan_query", check_plan_query},
    {"task_request", check_pipeline},
}};

} // namespace

std::vector<schema_error> semantic_errors(std::string_view type,
                                          const json& document) {
  error_list errors;
  for (const auto& [name, check] : checks)
    if (name == type)
      check(errors, {document, pointer{}});
  return errors;
}

} // namespace roscell
