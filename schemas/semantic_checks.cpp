#include "schemas/validator.hpp"

#include "messages/stream_protocols.hpp"
#include "schemas/checks/descriptor_checks.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

using namespace checks;

void check_members(error_list& errors, const place& formation) {
  std::set<json> seen;
  for (const auto& name : (formation / "members").items())
    if (!seen.insert(name.value).second)
      refuse(errors, name, "a name that is not in the list already");
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
  if (ends.value.is_object() && (ends / "protocol").text() == protocols::file)
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

/// What the engine tells a program by its environment: a step that said
/// otherwise would take it out of its cell.
bool is_of_engine(std::string_view variable) {
  constexpr std::array<std::string_view, 8> names{
      "NOTIFY_SOCKET",        "WATCHDOG_USEC",      "ROS_DISCOVERY_SERVER",
      "ROS_DOMAIN_ID",        "ROS_LOCALHOST_ONLY", "RMW_IMPLEMENTATION",
      "CUDA_VISIBLE_DEVICES", "ROS_STATIC_PEERS"};
  constexpr std::string_view own = "ROSCELL_";
  return variable.substr(0, own.size()) == own
         || std::find(names.begin(), names.end(), variable) != names.end();
}

void check_env(error_list& errors, const place& variables) {
  if (!variables.value.is_object())
    return;
  for (const auto& [name, value] : variables.value.items())
    if (is_of_engine(name))
      errors.push_back({(variables.at / name).to_string(),
                        "expected a variable that the engine does not set "
                        "itself, got "
                            + in_quotes(name)});
}

/// A variable is a text or a secret.
void check_apart(error_list& errors, const place& texts, const place& secrets) {
  if (!texts.value.is_object() || !secrets.value.is_object())
    return;
  for (const auto& [name, secret] : secrets.value.items())
    if (texts.value.contains(name))
      errors.push_back({(secrets.at / name).to_string(),
                        "expected a variable that \"env\" does not set too, "
                        "got "
                            + in_quotes(name)});
}

void check_pipeline(error_list& errors, const place& request) {
  auto steps = request / "pipeline";
  check_unique(errors, steps, "id", "an id that no other step has");
  for (const auto& step : steps.items()) {
    check_streams(errors, step);
    check_env(errors, step / "env");
    check_env(errors, step / "secret_env");
    check_apart(errors, step / "env", step / "secret_env");
  }
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

constexpr std::array<std::pair<std::string_view, check>, 12> all_checks{{
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
    {"task_set_request", check_pipeline},
    {"task_update", check_pipeline},
}};

} // namespace

std::vector<schema_error> semantic_errors(std::string_view type,
                                          const json& document) {
  error_list errors;
  for (const auto& [name, check] : all_checks)
    if (name == type)
      check(errors, {document, pointer{}});
  return errors;
}

} // namespace roscell
