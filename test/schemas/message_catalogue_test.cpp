#include "schemas/message_catalogue.hpp"

#include "messages/codec/json_codec.hpp"
#include "test/schemas/examples.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

failure refusal(const json& message,
                std::initializer_list<message_kind> allowed = {}) {
  auto why = validate_message(message, allowed);
  REQUIRE(why);
  return *why;
}

} // namespace

TEST_CASE("every request names a reply, and that reply is known") {
  for (const auto& type : message_types()) {
    INFO(type.name);
    if (type.kind == message_kind::request) {
      auto reply = find_message_type(type.reply);
      REQUIRE(reply != nullptr);
      CHECK(reply->kind == message_kind::reply);
    } else if (!type.reply.empty()) {
      CHECK(find_message_type(type.reply) != nullptr);
    }
  }
}

TEST_CASE("a type is found by its whole name only") {
  REQUIRE(find_message_type("task_request") != nullptr);
  CHECK(find_message_type("task_request")->reply == "task_accepted");
  for (auto name : {"", "task", "task_requests", "Task_request", "zzz"})
    CHECK(find_message_type(name) == nullptr);
}

TEST_CASE("a message without a type is refused at the place where it belongs") {
  auto why = refusal({{"task", "a"}});
  CHECK(why.code == error_code::schema_violation);
  CHECK(why.where == "/type");
  CHECK(refusal({{"type", 7}}).where == "/type");
  CHECK(refusal({{"type", 7}}).message.find("got the number 7")
        != std::string::npos);
  CHECK(refusal(json::array({1})).where.empty());
  CHECK(refusal(json(nullptr)).code == error_code::schema_violation);
}

TEST_CASE("an unknown type is refused with the nearest known one") {
  auto why = refusal({{"type", "task_reqest"}});
  CHECK(why.code == error_code::unknown_type);
  CHECK(why.where == "/type");
  CHECK(why.hint == R"(did you mean "task_request"?)");
}

TEST_CASE("a type that is near none is refused with the list of all") {
  auto why = refusal({{"type", "dance"}}, {message_kind::request});
  CHECK(why.hint.find(" task_request ") != std::string::npos);
  CHECK(why.hint.find("session_hello") == std::string::npos);
}

TEST_CASE("a very long type is refused in few words") {
  auto why = refusal({{"type", std::string(1'000'000, 'x')}});
  CHECK(why.message.size() < 200);
}

TEST_CASE("a known type of another kind is refused as such") {
  json reply{{"type", "node_departed"}};
  CHECK_FALSE(validate_message(reply));
  CHECK_FALSE(validate_message(reply, {message_kind::session}));
  auto why = refusal(reply, {message_kind::request, message_kind::reply});
  CHECK(why.code == error_code::unknown_type);
  CHECK(why.message.find("its kind is session") != std::string::npos);
}

TEST_CASE("a document without a type is not taken as a message") {
  for (auto name : {"skill_descriptor", "plan_document", "common"})
    CHECK(refusal({{"type", name}}).code == error_code::unknown_type);
}

TEST_CASE("schema and semantic errors are reported together") {
  auto why = refusal(json::parse(R"({"type":"task_request","pipeline":[
    {"id":"a","operation":"o","model":"m"},
    {"id":"a","operation":"o"}]})"));
  CHECK(why.code == error_code::schema_violation);
  auto errors = json::parse(why.details)["errors"];
  REQUIRE(errors.size() == 3);
  CHECK(errors[0]["where"] == "/pipeline/1/model");
  CHECK(errors[1]["where"] == "/task");
  CHECK(errors[2]["where"] == "/pipeline/1/id");
  CHECK(why.where == "/pipeline/1/model");
}

TEST_CASE("messages of the examples are judged as their documents are") {
  for (const auto& x : test::examples()) {
    auto type = find_message_type(x.type);
    if (type == nullptr || type->kind >= message_kind::document)
      continue;
    INFO(x.name);
    CHECK(validate_message(x.document).has_value() != x.valid);
  }
}

TEST_CASE("an error reply about any example is itself a valid message") {
  for (const auto& x : test::examples()) {
    INFO(x.name);
    if (auto why = validate_document(x.type, x.document))
      CHECK_FALSE(validate_message(error_reply(*why)));
  }
}

TEST_CASE("docs/messages.md names every message type") {
  auto text = test::read_file(test::source_dir() / "docs/messages.md");
  for (const auto& type : message_types()) {
    INFO(type.name);
    if (type.kind != message_kind::part)
      CHECK(text.find("`" + std::string{type.name} + "`") != std::string::npos);
  }
}

namespace {

json request_with(const char* member, const json& value) {
  json step{{"id", "a"}, {"operation", "echo"}, {"model", "plain"}};
  step[member] = value;
  return {{"type", "task_request"}, {"task", "t"}, {"pipeline", {step}}};
}

} // namespace

TEST_CASE("a misspelt member of a request is refused with the one meant") {
  const auto why = validate_request(request_with("label", {{"a", "b"}}));
  REQUIRE(why);
  CHECK(why->code == error_code::schema_violation);
  CHECK(why->where == "/pipeline/0/label");
  CHECK(why->message
        == "/pipeline/0/label: there is no member \"label\" here; did you mean "
           "\"labels\"?");
}

TEST_CASE("a member's name in other systems leads to the one here") {
  const auto why = validate_request(
      {{"type", "task_request"}, {"task", "t"}, {"steps", json::array()}});
  REQUIRE(why);
  const auto errors = json::parse(why->details).at("errors");
  REQUIRE(errors.size() == 2);
  CHECK(errors[0].at("where") == "/pipeline");
  CHECK(errors[1].at("where") == "/steps");
  CHECK(errors[1].at("expected")
        == "there is no member \"steps\" here; did you mean \"pipeline\"?");
}

TEST_CASE("words of other systems lead to those here, or say what to do") {
  const std::pair<const char*, const char*> words[] = {
      {"nodeSelector", "did you mean \"labels\"?"},
      {"image", "did you mean \"operation\"?"},
      {"max_retries", "did you mean \"restart\"?"},
      {"restartPolicy", "did you mean \"restart\"?"},
      {"environment", "did you mean \"env\"?"},
      {"args", "did you mean \"arguments\"?"},
      {"command", "did you mean \"arguments\"?"},
      {"depends_on", "did you mean \"input\"?"},
      {"livenessProbe", "did you mean \"health\"?"},
      {"constraint", "did you mean \"labels\"?"},
      {"replicas", "write a step for each"},
      {"ports", "the network of its host"},
      {"resources", "said by its skill.json"}};
  for (const auto& [foreign, own] : words) {
    INFO(foreign);
    const auto why = validate_request(request_with(foreign, 1));
    REQUIRE(why);
    CHECK(why->where == "/pipeline/0/" + std::string{foreign});
    CHECK(why->message.find(own) != std::string::npos);
  }
}

TEST_CASE("a member that is near none is refused with those there are") {
  const auto why =
      validate_request({{"type", "task_query"}, {"colour", "red"}});
  REQUIRE(why);
  CHECK(why->message
        == "/colour: there is no member \"colour\" here; there are request_id, "
           "task, type");
}

TEST_CASE("unknown members are found in every endpoint of a list") {
  const json end{{"protocol", "file"}, {"endpoint", "/a"}, {"data_type", "x"}};
  auto odd = end;
  odd["topic"] = "y";
  const auto why = validate_request(request_with("input", {end, odd}));
  REQUIRE(why);
  CHECK(why->where == "/pipeline/0/input/1/topic");
  CHECK(validate_request(request_with("input", odd))->where
        == "/pipeline/0/input/topic");
}

TEST_CASE("parameters and labels may have any name") {
  CHECK_FALSE(validate_request(request_with("parameters", {{"odd", 1}})));
  CHECK_FALSE(validate_request(request_with("labels", {{"odd", "x"}})));
}

TEST_CASE("what a newer peer says more is no error") {
  CHECK_FALSE(validate_message(request_with("label", {{"a", "b"}})));
}

TEST_CASE("an unknown member of a descriptor is refused") {
  for (const auto& x : test::examples()) {
    if (x.type != "skill_descriptor" || !x.valid)
      continue;
    CHECK_FALSE(validate_document(x.type, x.document));
    auto odd = x.document;
    odd["models"][0]["deployment"] = json::array();
    const auto why = validate_document(x.type, odd);
    REQUIRE(why);
    CHECK(why->where == "/models/0/deployment");
    CHECK(why->message.find("\"deployments\"") != std::string::npos);
  }
}
