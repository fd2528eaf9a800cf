#include "tools/roscell/client/document_parts.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/view/update_view.hpp"

#include <catch2/catch.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <string>
#include <vector>

/// Files that hold several documents, and what changes of tasks look like.
namespace roscell::cli::test {

namespace {

struct scratch_file {
  std::string name;

  scratch_file(const std::string& ending, const std::string& text)
      : name{(std::filesystem::temp_directory_path()
              / ("roscell-documents-" + std::to_string(::getpid()) + ending))
                 .string()} {
    std::ofstream{name} << text;
  }
  ~scratch_file() {
    std::remove(name.c_str());
  }
  scratch_file(const scratch_file&) = delete;
  scratch_file& operator=(const scratch_file&) = delete;
};

std::vector<std::string> tasks_in(const std::string& ending,
                                  const std::string& text) {
  const scratch_file file{ending, text};
  std::vector<std::string> result;
  for (const auto& x : read_task_files(file.name, {}))
    result.push_back(x.request().value("task", "none"));
  return result;
}

failure problem_of(const std::string& ending, const std::string& text) {
  const scratch_file file{ending, text};
  try {
    read_task_files(file.name, {});
  } catch (const wrong_document& e) {
    return e.why;
  }
  FAIL("it was taken");
  return {};
}

using names = std::vector<std::string>;

} // namespace

TEST_CASE("lines of --- part the documents of a YAML file", "[documents]") {
  CHECK(tasks_in(".yaml", "task: a\n---\ntask: b\n") == names{"a", "b"});
  CHECK(tasks_in(".yaml", "# first\n---\ntask: a\n---\n# none\n---\n\n...\n"
                          "--- \ntask: b\n--- {task: c}\n")
        == names{"a", "b", "c"});
  CHECK(tasks_in(".yaml", "task: a\nnote: |\n  ---\n  text\n") == names{"a"});
  CHECK(tasks_in(".yaml", "task: a--- b\n---x: 1\n") == names{"a--- b"});
  CHECK(tasks_in(".yaml", "").empty());
  CHECK(tasks_in(".yaml", "# nothing\n").empty());
}

TEST_CASE("a list holds the documents of a JSON file", "[documents]") {
  CHECK(tasks_in(".json", R"([{"task": "a"}, {"task": "b"}])")
        == names{"a", "b"});
  CHECK(tasks_in(".json", R"({"task": "a"})") == names{"a"});
  CHECK(tasks_in(".json", "[]").empty());
}

TEST_CASE("a place in a later document is one of the file", "[documents]") {
  CHECK(problem_of(".yaml", "task: a\n---\ntask: [\n").message.find("line 4")
        == 0);
  const auto parts = yaml_documents("a: 1\n---\nb: 2\n");
  REQUIRE(parts.size() == 2);
  CHECK(parts[1] == "\n   \nb: 2\n");
  failure why{error_code::schema_violation, "", "/task", "",
              R"({"errors":[{"where":"/task","expected":"x"}]})"};
  const auto whole = within(why, "/3");
  CHECK(whole.where == "/3/task");
  CHECK(json::parse(whole.details).at("errors").at(0).at("where") == "/3/task");
}

TEST_CASE("a document says which kind it is, and is a task else",
          "[documents]") {
  CHECK(tasks_in(".yaml", "kind: task\ntask: a\n") == names{"a"});
  CHECK(problem_of(".yaml", "kind: fleet\ntask: a\n").where == "/kind");
  CHECK(problem_of(".json", R"([{"task": "a"}, {"kind": 7}])").where
        == "/1/kind");
}

TEST_CASE("changes of a task are shown step by step, with their reasons",
          "[update_view]") {
  task_update_plan plan;
  plan.task = "poses";
  plan.outcome = update_outcome::shown;
  plan.reasons = {"timeout_s: none -> 60"};
  plan.changes = {{"camera", step_action::stays, "i", "arm", "arm", {}},
                  {"pose",
                   step_action::restarts,
                   "j",
                   "arm",
                   "arm",
                   {"parameters.decimation: 2 -> 3", "build: aa -> bb"}}};
  CHECK(changes_view({plan}, {})
        == "TASK   STEP    ACTION    FROM  TO   WHY\n"
           "poses  -       changes   -     -    timeout_s: none -> 60\n"
           "poses  camera  stays     arm   arm  -\n"
           "poses  pose    restarts  arm   arm  parameters.decimation: 2 -> 3; "
           "build: aa -> bb\n");
  CHECK(changes_view({}, {}).empty());
}

TEST_CASE("revisions of a task are shown with the steps that each changed",
          "[update_view]") {
  const auto request = [](const char* model) {
    return json{
        {"pipeline", {{{"id", "camera"}}, {{"id", "pose"}, {"model", model}}}}}
        .dump();
  };
  task_revisions known;
  known.task = "poses";
  known.revisions = {{3, 1000, request("a"), {{"pose", "aaaa"}}},
                     {4, 60'000, request("b"), {}},
                     {5, 120'000, "damaged", {}}};
  CHECK(revisions_view(known, {}, 180'000)
        == "REVISION  SINCE  STEPS  CHANGED       BUILDS\n"
           "       3  2m59s      2  -             pose=aaaa\n"
           "       4  2m00s      2  pose          -\n"
           " 5 (now)  1m00s      0  camera, pose  -\n");
}

} // namespace roscell::cli::test
