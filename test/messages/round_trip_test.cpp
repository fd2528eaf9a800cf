#include "messages/allocation_report.hpp"
#include "messages/event.hpp"
#include "messages/failure.hpp"
#include "schemas/message_catalogue.hpp"
#include "schemas/validator.hpp"
#include "test/messages/member_count.hpp"
#include "test/messages/trial.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace roscell;
using namespace roscell::test;

namespace {

/// Every member of every object, as places in the document.
void collect_members(const json& x, const json::json_pointer& at,
                     std::vector<json::json_pointer>& result) {
  if (x.is_object()) {
    for (const auto& [name, value] : x.items()) {
      result.push_back(at / name);
      collect_members(value, at / name, result);
    }
  } else if (x.is_array()) {
    for (size_t i = 0; i < x.size(); ++i)
      collect_members(x[i], at / i, result);
  }
}

std::vector<json::json_pointer> members_of(const json& document) {
  std::vector<json::json_pointer> result;
  collect_members(document, json::json_pointer{}, result);
  return result;
}

/// Objects that hold what only their users know.
bool is_free_form(const json::json_pointer& place) {
  return !place.empty()
         && (place.back() == "parameters" || place.back() == "data"
             || place.back() == "body" || place.back() == "state"
             || place.back() == "request" || place.back() == "former");
}

void check_valid(const std::string& schema, const json& document) {
  for (const auto& error :
       document_errors(schema, document, unknown_members::taken))
    FAIL_CHECK(error.pointer << ": " << error.expected);
}

/// Their lists must not be empty, so they have no least form.
bool has_least_form(const std::string& name) {
  return name != "task_request" && name != "task_plan_query"
         && name != "task_update" && name != "skill_descriptor"
         && name != "plan_document" && name != "cell_formation"
         && name != "skill_added" && name != "skill_pulled"
         && name != "exec_request" && name != "task_set_request"
         && name != "parameter_change" && name != "set_parameters"
         && name != "site_invited";
}

} // namespace

TEST_CASE("a message with every field set survives JSON") {
  for (const auto& x : message_trials()) {
    INFO(x.name << " " << x.full.dump(2));
    CHECK(x.full_survives);
    // A program of the folder and one of ROS 2 exclude each other.
    if (x.name != "skill_descriptor" && x.name != "plan_document")
      check_valid(x.name, x.full);
  }
}

TEST_CASE("a message with its least fields survives JSON") {
  for (const auto& x : message_trials()) {
    INFO(x.name << " " << x.least.dump(2));
    CHECK(x.least_survives);
    if (has_least_form(x.name))
      check_valid(x.name, x.least);
  }
}

TEST_CASE("every part of a message survives JSON") {
  for (const auto& x : part_trials()) {
    INFO(x.name << " " << x.full.dump(2));
    CHECK(x.full_survives);
    CHECK(x.least_survives);
  }
}

TEST_CASE("every member of a struct is among its fields") {
  for (const auto& trials : {message_trials(), part_trials()})
    for (const auto& x : trials) {
      INFO(x.name);
      CHECK(x.members == x.fields);
    }
}

TEST_CASE("every field of a message is described by its schema") {
  // What a schema does not describe it ignores, so it would take both of these.
  const json damages[] = {true, json::array({json::array()})};
  for (const auto& x : message_trials()) {
    for (const auto& member : members_of(x.full)) {
      if (is_free_form(member.parent_pointer()))
        continue;
      size_t noticed = 0;
      for (const auto& damage : damages) {
        auto document = x.full;
        document[member] = damage;
        if (!validator::shared().validate(x.name, document).empty())
          ++noticed;
      }
      INFO(x.name << member.to_string());
      CHECK(noticed > 0);
    }
  }
}

TEST_CASE("what a schema lets out, the struct can do without") {
  for (const auto& x : message_trials()) {
    for (const auto& member : members_of(x.full)) {
      auto document = x.full;
      document[member.parent_pointer()].erase(member.back());
      INFO(x.name << " without " << member.to_string());
      if (validator::shared().validate(x.name, document).empty())
        CHECK(x.decodes(document));
    }
  }
}

TEST_CASE("every message type has a struct that is tried here") {
  // The struct of one is `failure`, the other is read part by part.
  std::set<std::string> tried{"error", "cell_document"};
  for (const auto& x : message_trials())
    tried.insert(x.name);
  for (const auto& type : message_types()) {
    INFO(type.name);
    if (type.kind != message_kind::part)
      CHECK(tried.count(std::string{type.name}) == 1);
  }
}

TEST_CASE("a failure survives its error reply") {
  const failure why{error_code::conflict, "the port is in use", "/port",
                    "choose another one", R"({"holder":{"pid":7}})"};
  CHECK(member_count<failure>() == decltype(failure::fields())::size);
  auto reply = error_reply(why);
  CHECK_FALSE(validate_message(reply));
  CHECK(reply["error"]["holder"]["pid"] == 7);
  CHECK(failure_from(reply) == why);
}

TEST_CASE("an error reply may say anything instead of words") {
  CHECK(failure_from(json::object()).code == error_code::internal);
  const auto odd = failure_from(
      {{"error", {{"code", 7}, {"message", json::array()}, {"hint", "h"}}}});
  CHECK(odd == failure{error_code::internal, "", "", "h", ""});
}

TEST_CASE("every error code survives its word") {
  for (int i = 1; i <= static_cast<int>(error_code::internal); ++i) {
    auto code = static_cast<error_code>(i);
    CHECK(error_code_from(to_word(code)) == code);
    CHECK_FALSE(validate_message(error_reply({code, "x", "", "", ""})));
  }
}

TEST_CASE("one stream is written as an object, several as an array") {
  task_step step{"a", "o", "m"};
  CHECK_FALSE(json(step).contains("input"));
  step.input.resize(1);
  CHECK(json(step)["input"].is_object());
  step.input.resize(2);
  CHECK(json(step)["input"].size() == 2);
  CHECK(json(step).get<task_step>() == step);
}

TEST_CASE("an index that is not there is written as null") {
  step_allocation x;
  CHECK(json(x)["gpu"].is_null());
  CHECK(json(x).get<step_allocation>().gpu == -1);
  x.gpu = 0;
  CHECK(json(x)["gpu"] == 0);
}

TEST_CASE("JSON that a struct keeps as text is written as JSON") {
  event x;
  CHECK_FALSE(json(x).contains("data"));
  x.data = R"({"epoch":3})";
  CHECK(json(x)["data"]["epoch"] == 3);
}
