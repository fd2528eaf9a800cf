#include "actors/placement/questions/task_allocation.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <catch2/catch.hpp>

#include <limits>

namespace roscell::test {

namespace {

/// Two nodes, one of them with a GPU, and a step for each.
json two_nodes() {
  return json::parse(R"({
    "nodes": [
      {"name": "a", "architecture": "amd64", "unified_memory": false,
       "cpu": {"capacity": 4, "used": 0},
       "memory_mib": {"capacity": 1000, "used": 0},
       "disk_mib": {"capacity": 100, "used": 0},
       "gpus": [], "labels": {"room": "hall"}, "devices": []},
      {"name": "g", "architecture": "amd64", "unified_memory": false,
       "cpu": {"capacity": 4, "used": 2},
       "memory_mib": {"capacity": 2000, "used": 1000},
       "disk_mib": {"capacity": 100, "used": 0},
       "gpus": [{"index": 1, "memory_mib": {"capacity": 1000, "used": 500}}],
       "labels": {}, "devices": []}],
    "skills": [
      {"operation": "echo", "engine": "primitive", "entry_point": ["bin/echo"],
       "input": {"data_types": ["text/plain"], "protocols": ["file"]},
       "output": {"data_types": ["text/plain"], "protocols": ["file"]},
       "models": [{"name": "plain", "deployments": [
         {"name": "cpu", "base_image": "debian", "architectures": ["amd64"],
          "resources": {"cpu": 1, "memory_mib": 100, "disk_mib": 10}}]}]},
      {"operation": "see", "engine": "primitive", "entry_point": ["bin/see"],
       "input": {"data_types": ["image/png"], "protocols": ["file"]},
       "output": {"data_types": ["text/plain"], "protocols": ["file"]},
       "models": [{"name": "yolo", "deployments": [
         {"name": "gpu", "base_image": "debian", "architectures": ["amd64"],
          "resources": {"cpu": 1, "memory_mib": 500, "disk_mib": 50,
                        "gpu_memory_mib": 250}}]}]}],
    "request": {"type": "task_request", "task": "t", "pipeline": [
      {"id": "s0", "operation": "echo", "model": "plain",
       "labels": {"room": "hall"}},
      {"id": "s1", "operation": "see", "model": "yolo"}]}})");
}

plan_document read(const json& document) {
  return std::get<plan_document>(decode<plan_document>(document));
}

/// A plan that there must be, or the reason why there is none.
template <class T>
T must_be(const std::variant<task_plan, failure>& result) {
  REQUIRE(std::holds_alternative<T>(result));
  return std::get<T>(result);
}

std::variant<task_plan, failure> outcome_of(const json& document) {
  REQUIRE_FALSE(validate_document("plan_document", document));
  return allocate_offline(read(document));
}

task_plan plan(const json& document) {
  return must_be<task_plan>(outcome_of(document));
}

failure refusal(const json& document) {
  return must_be<failure>(outcome_of(document));
}

/// The first step, on nodes with any labels.
resolved_step step_anywhere(const plan_document& document) {
  resolved_step result;
  result.step = document.request.pipeline[0];
  result.step.labels.clear();
  return result;
}

} // namespace

TEST_CASE("A plan on paper has the numbers of the paper's equations",
          "[task_allocation]") {
  const auto reply = message_json(plan(two_nodes()));
  CHECK_FALSE(validate_message(reply));
  CHECK(reply.at("type") == "task_plan");
  CHECK(reply.at("task") == "t");
  CHECK(reply.at("optimal") == true);

  const auto& first = reply.at("allocations").at(0);
  CHECK(first.at("step") == "s0");
  CHECK(first.at("node") == "a");
  CHECK(first.at("deployment") == "cpu");
  CHECK(first.at("gpu").is_null());
  CHECK(first.at("fractions").at("cpu") == Approx(1.0 / 4));
  CHECK(first.at("fractions").at("memory") == Approx(1.0 / 10));
  CHECK(first.at("fractions").at("disk") == Approx(1.0 / 10));
  CHECK(first.at("fractions").count("gpu_memory") == 0);
  // ((1/10)^2 + 2 (1/20)^2) / 3
  CHECK(first.at("variance") == Approx(0.005));
  CHECK(first.at("bonus") == 0);

  const auto& second = reply.at("allocations").at(1);
  CHECK(second.at("node") == "g");
  CHECK(second.at("gpu") == 1);
  for (const auto* resource : {"cpu", "memory", "disk", "gpu_memory"})
    CHECK(second.at("fractions").at(resource) == Approx(1.0 / 2));
  CHECK(second.at("variance") == Approx(0).margin(1e-15));
  CHECK(second.at("bonus") == Approx(-0.01));

  const auto& score = reply.at("score");
  CHECK(score.at("balance") == Approx((0.005 - 0.01) / 2));
  // Loads 0.175 and 0.75 are 0.2875 from their mean.
  CHECK(score.at("load") == Approx(0.2875 * 0.2875));
  CHECK(score.at("total") == Approx(-0.0025 + 0.1 * 0.08265625));

  const auto& rejected = reply.at("rejected");
  REQUIRE(rejected.size() == 2);
  CHECK(rejected[0].at("step") == "s0");
  CHECK(rejected[0].at("node") == "g");
  CHECK(rejected[0].at("deployment") == "cpu");
  CHECK(rejected[0].at("reasons").size() == 1);
  CHECK(rejected[1].at("step") == "s1");
  CHECK(rejected[1].at("node") == "a");
}

TEST_CASE("A node is no place for a step whose secrets it does not have",
          "[task_allocation][secrets]") {
  auto document = two_nodes();
  document["nodes"][0]["secrets"] = {"key"};
  auto& step = document["request"]["pipeline"][0];
  step["secrets"] = {"key"};
  CHECK(plan(document).allocations[0].node == "a");
  step["secret_env"] = {{"PASSWORD", "pass"}};
  const auto why = refusal(document);
  CHECK(why.code == error_code::no_feasible_allocation);
  CHECK(why.details.find("needs the secret 'pass', the node does not have it")
        != std::string::npos);
  CHECK(why.details.find(R"("kind":"excluded")") != std::string::npos);
}

TEST_CASE("A node is no place for what it does not grant to the skill",
          "[task_allocation][grants]") {
  auto document = two_nodes();
  auto& see = document["skills"][1]["models"][0]["deployments"][0];
  see["capabilities"] = {"NET_RAW"};
  see["scheduling"] = {{"policy", "fifo"}, {"priority", 10}};
  const auto reported = refusal(document);
  const auto rejected = json::parse(reported.details).at("rejected");
  std::vector<std::string> reasons;
  for (const auto& x : rejected)
    if (x.at("node") == "g" && x.at("step") == "s1")
      reasons = x.at("reasons").get<std::vector<std::string>>();
  CHECK(reasons
        == std::vector<std::string>{
            "skill 'see' wants capability NET_RAW, which node 'g' does not "
            "grant it: grant = see=capability:NET_RAW",
            "skill 'see' wants scheduling fifo 10, which node 'g' does not "
            "grant it: grant = see=scheduling:fifo:10"});
  document["nodes"][1]["grants"] = {
      "see=capability:NET_RAW,scheduling:fifo:20"};
  CHECK(plan(document).task == "t");
  // What this version does not understand grants nothing.
  document["nodes"][1]["grants"] = {"see=everything"};
  CHECK(refusal(document).code == error_code::no_feasible_allocation);
}

TEST_CASE("Each node has a label with its name, unless it was given another",
          "[task_allocation]") {
  auto document = two_nodes();
  auto& labels = document["request"]["pipeline"][0]["labels"];
  labels = {{"node", "a"}};
  CHECK(plan(document).task == "t");
  labels = {{"node", "nobody"}};
  CHECK(refusal(document).details.find(
            "needs the label 'node=nobody', the node has 'node=a'")
        != std::string::npos);
  document["nodes"][0]["labels"]["node"] = "nobody";
  CHECK(plan(document).task == "t");
}

TEST_CASE("What does not fit is refused with every candidate explained",
          "[task_allocation]") {
  auto document = two_nodes();
  document["nodes"][1]["gpus"][0]["memory_mib"]["used"] = 900;
  document["nodes"][1]["cpu"]["used"] = 3.5;
  const auto why = refusal(document);
  CHECK(why.code == error_code::no_feasible_allocation);
  CHECK(why.where == "/pipeline");
  const auto reply = error_reply(why);
  CHECK_FALSE(validate_message(reply));
  const auto& rejected = reply.at("error").at("rejected");
  json of_gpu;
  for (const auto& x : rejected)
    if (x.at("step") == "s1" && x.at("node") == "g")
      of_gpu = x;
  REQUIRE(of_gpu.is_object());
  const auto reasons = of_gpu.at("reasons").dump();
  CHECK(of_gpu.at("reasons").size() == 2);
  // 250 MiB wanted, 100 free; 1 core wanted, 0.5 free.
  CHECK(reasons.find("GPU 1: ") != std::string::npos);
  CHECK(reasons.find("150") != std::string::npos);
  CHECK(reasons.find("0.5") != std::string::npos);
}

TEST_CASE("On paper as in a cell an unknown operation has a pointer and a hint",
          "[task_allocation]") {
  auto document = two_nodes();
  document["request"]["pipeline"][1]["operation"] = "hear";
  const auto why = refusal(document);
  CHECK(why.code == error_code::unknown_operation);
  CHECK(why.where == "/request/pipeline/1/operation");
  CHECK(why.hint.find("echo, see") != std::string::npos);
}

TEST_CASE("A named deployment option is the only candidate",
          "[task_allocation]") {
  auto document = two_nodes();
  auto& options = document["skills"][0]["models"][0]["deployments"];
  options.push_back(options[0]);
  options[1]["name"] = "big";
  options[1]["resources"]["cpu"] = 3;
  document["request"]["pipeline"][0]["deployment"] = "big";
  CHECK(plan(document).allocations[0].deployment == "big");
}

TEST_CASE("A node without the skill is rejected for that",
          "[task_allocation]") {
  const auto document = read(two_nodes());
  auto step = step_anywhere(document);
  step.builds = {{"h1", document.skills[0].models[0], {"g"}}};
  const auto found =
      must_be<task_plan>(allocate({"t", {step}, document.nodes}));
  CHECK(found.allocations[0].node == "g");
  REQUIRE(found.rejected.size() == 1);
  CHECK(found.rejected[0].node == "a");
}

TEST_CASE("Each node runs its own build, also where it is for another machine",
          "[task_allocation]") {
  auto document = read(two_nodes());
  document.nodes[1].architecture = "arm64";
  document.nodes[1].labels["room"] = "yard";
  resolved_step step;
  step.step = document.request.pipeline[0];
  auto model = document.skills[0].models[0];
  model.deployments[0].architectures = {"amd64", "arm64"};
  auto other = model;
  SECTION("of one descriptor") {}
  SECTION("of another descriptor that asks for more") {
    other.deployments[0].resources.cpu = 1.5;
  }
  step.builds = {{"h1", model, {"a"}}, {"h2", other, {"g"}}};
  for (const auto* room : {"hall", "yard"}) {
    step.step.labels["room"] = room;
    const auto found =
        must_be<task_plan>(allocate({"t", {step}, document.nodes}));
    const bool in_hall = room == std::string{"hall"};
    CHECK(found.allocations[0].node == (in_hall ? "a" : "g"));
    CHECK(found.allocations[0].build == (in_hall ? "h1" : "h2"));
    CHECK(found.allocations[0].deployment == "cpu");
    // The other node once, for its label: it does have a build.
    REQUIRE(found.rejected.size() == 1);
    CHECK(found.rejected[0].node == (in_hall ? "g" : "a"));
    REQUIRE(found.rejected[0].causes.size() == 1);
    CHECK(found.rejected[0].causes[0].kind == "label");
  }
}

TEST_CASE("A candidate that was refused is left out with its node's build",
          "[task_allocation]") {
  const auto document = read(two_nodes());
  auto step = step_anywhere(document);
  const auto& model = document.skills[0].models[0];
  auto other = model;
  other.deployments[0].resources.cpu = 1.5;
  step.builds = {{"h1", model, {"a"}}, {"h2", other, {"g"}}};
  const auto found = must_be<task_plan>(
      allocate({"t", {step}, document.nodes, {{"s0", "g", "cpu", -1, "no"}}}));
  CHECK(found.allocations[0].build == "h1");
}

TEST_CASE("A node without any build is rejected once, whatever the builds",
          "[task_allocation]") {
  const auto document = read(two_nodes());
  resolved_step step;
  step.step = document.request.pipeline[0];
  const auto& model = document.skills[0].models[0];
  auto other = model;
  other.deployments[0].resources.cpu = 1.5;
  step.builds = {{"h1", model, {"a"}}, {"h2", other, {"elsewhere"}}};
  const auto found =
      must_be<task_plan>(allocate({"t", {step}, document.nodes}));
  CHECK(found.rejected.size() == 1);
}

TEST_CASE("A cell whose cores are busy is read with the floor, and says so",
          "[task_allocation]") {
  auto text = two_nodes();
  text["request"]["pipeline"].erase(1);
  text["nodes"][0]["cpu"]["used"] = 4;
  text["nodes"][0]["cpu_compressible"] = 1;
  const auto document = read(text);
  resolved_step step;
  step.step = document.request.pipeline[0];
  step.builds = {
      {std::string(64, 'a'), document.skills[0].models[0], {"a", "g"}}};
  const auto reply =
      message_json(must_be<task_plan>(allocate({"t", {step}, document.nodes})));
  const auto why = validate_message(reply);
  INFO((why ? why->message + " " + why->where : ""));
  CHECK_FALSE(why);
  CHECK(reply.at("cpu_floor") == true);
  CHECK(reply.at("warnings").size() == 1);
  // What is used stays what it is.
  CHECK(reply.at("use").at(0).at("before") == 4);
  CHECK(reply.at("use").at(0).at("after") == 5);
  // On paper the numbers are meant as they stand.
  CHECK(refusal(text).code == error_code::no_feasible_allocation);
}

TEST_CASE("Without any node nothing can be placed", "[task_allocation]") {
  auto document = two_nodes();
  document["nodes"] = json::array();
  CHECK(must_be<failure>(allocate_offline(read(document))).code
        == error_code::no_feasible_allocation);
}

TEST_CASE("A rejected candidate has its causes for programs",
          "[task_allocation]") {
  auto document = two_nodes();
  document["nodes"][1]["gpus"][0]["memory_mib"]["used"] = 900;
  const auto reply = error_reply(refusal(document));
  for (const auto& x : reply.at("error").at("rejected")) {
    REQUIRE(x.at("causes").size() == x.at("reasons").size());
    if (x.at("step") != "s1" || x.at("node") != "g")
      continue;
    CHECK(x.at("gpu") == 1);
    CHECK(x.at("causes")[0].at("kind") == "gpu_memory");
    CHECK(x.at("causes")[0].at("needed") == 250);
    CHECK(x.at("causes")[0].at("free") == 100);
    CHECK(x.at("causes")[0].at("short_by") == 150);
  }
}

TEST_CASE("A cause that is no amount has no numbers", "[task_allocation]") {
  auto document = two_nodes();
  for (auto& step : document["request"]["pipeline"])
    step["labels"] = {{"place", "moon"}};
  const auto reply = error_reply(refusal(document));
  const auto& rejected = reply.at("error").at("rejected");
  REQUIRE_FALSE(rejected.empty());
  for (const auto& x : rejected)
    CHECK(x.at("causes")[0] == json{{"kind", "label"}});
  CHECK_FALSE(validate_message(reply));
}

TEST_CASE("A plan tells the use of its nodes, and its bound",
          "[task_allocation]") {
  const auto found = plan(two_nodes());
  CHECK(found.score.lower_bound == found.score.total);
  CHECK(found.score.gap == 0);
  CHECK(found.score.alpha == 0.1);
  REQUIRE(found.use.size() == 3 + 4);
  CHECK(found.use[0] == resource_use{"a", "cpu", 4, 0, 1});
  CHECK(found.use[6] == resource_use{"g", "gpu_1", 1000, 500, 750});
  CHECK_FALSE(validate_message(message_json(found)));
}

TEST_CASE("The alternative of a step that can be nowhere else is an obstacle",
          "[task_allocation]") {
  const auto document = read(two_nodes());
  const auto found = must_be<task_plan>(allocate_offline(document, "s1"));
  REQUIRE(found.alternatives.size() == 1);
  CHECK(found.alternatives[0].step == "s1");
  CHECK(found.alternatives[0].allocations.empty());
  CHECK(found.alternatives[0].obstacle == "step 's1' fits on no node");
  CHECK_FALSE(validate_message(message_json(found)));
  const auto unknown = must_be<failure>(allocate_offline(document, "s9"));
  CHECK(unknown.where == "/why");
}

namespace {

/// Where the schema finds fault, and what it says.
failure schema_refusal(const json& document) {
  const auto why = validate_document("plan_document", document);
  REQUIRE(why);
  return *why;
}

} // namespace

TEST_CASE("Bad resources and names on paper are refused by their place",
          "[task_allocation]") {
  // JSON has neither NaN nor infinity; a library writes null for them.
  const auto [at, bad, where] = GENERATE(table<std::string, json, std::string>(
      {{"/nodes/0/cpu/used", -1, ""},
       {"/nodes/1/memory_mib/capacity", 1e15, ""},
       {"/nodes/0/cpu/capacity", nullptr, ""},
       {"/nodes/1/name", "a", ""},
       {"/request/pipeline/1/id", "s0", ""},
       {"/request/pipeline", json::array(), ""},
       // A GPU twice.
       {"/nodes/1/gpus/1", two_nodes().at("/nodes/1/gpus/0"_json_pointer),
        "/index"}}));
  auto document = two_nodes();
  document[json::json_pointer{at}] = bad;
  CHECK(schema_refusal(document).where == at + where);
}

TEST_CASE("10,000 steps are refused with the limit", "[task_allocation]") {
  auto document = two_nodes();
  auto& steps = document["request"]["pipeline"];
  for (int i = 2; i < 10'000; ++i) {
    steps.push_back(steps[0]);
    steps.back()["id"] = "s" + std::to_string(i);
  }
  const auto why = schema_refusal(document);
  CHECK(why.where == "/request/pipeline");
  CHECK(why.message.find("128") != std::string::npos);
}

TEST_CASE("Numbers that no schema has seen are refused by the search",
          "[task_allocation]") {
  auto document = read(two_nodes());
  const auto bad = GENERATE(-1.0, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity(), 1e300);
  document.nodes[0].disk_mib.capacity = bad;
  const auto why = must_be<failure>(allocate_offline(document));
  CHECK(why.code == error_code::schema_violation);
  CHECK(why.message.find("nodes[0].disk_mib.capacity") != std::string::npos);
}

TEST_CASE("A node that uses more than it has is full, with a warning; one "
          "without capacity hosts nothing",
          "[task_allocation]") {
  auto document = two_nodes();
  document["request"]["pipeline"].erase(1);
  document["nodes"][0]["cpu"] = {{"capacity", 4}, {"used", 5}};
  auto why = refusal(document);
  CHECK(why.details.find("needs 1.0 cores, 0.0 free: short by 1.0")
        != std::string::npos);
  document["nodes"][0]["cpu"] = {{"capacity", 0}, {"used", 0}};
  why = refusal(document);
  CHECK(why.details.find("the node offers no CPU") != std::string::npos);

  document["nodes"][0]["cpu"] = {{"capacity", 4}, {"used", 0}};
  document["nodes"][0]["disk_mib"] = {{"capacity", 4}, {"used", 5}};
  document["skills"][0]["models"][0]["deployments"][0]["resources"]
          ["disk_mib"] = 0;
  CHECK(plan(document).warnings.size() == 1);
}

} // namespace roscell::test
