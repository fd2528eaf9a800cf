#include "actors/session/registration_client.hpp"
#include "messages/messages.hpp"

#include <catch2/catch.hpp>

#include <string>

namespace roscell::test {

namespace {

failure refusal(const std::string& text) {
  const auto read = answer_as<registration_challenge>(text);
  REQUIRE(std::holds_alternative<failure>(read));
  return std::get<failure>(read);
}

} // namespace

TEST_CASE("an unauthenticated peer's answer is no node's, whatever it is",
          "[node_answer]") {
  for (const auto* text :
       {"", "<html>", "7", "[]", "{}", R"({"type":7})", R"({"type":["error"]})",
        R"({"type":"error"})", R"({"type":"error","error":{"code":7}})",
        R"({"type":"make_coffee"})", R"({"type":"task_request"})",
        R"({"type":"registration_challenge","node":7})"}) {
    INFO(text);
    const auto why = refusal(text);
    CHECK(why.code == error_code::unreachable);
    CHECK(why.message.find("is no node of ROSCell") != std::string::npos);
  }
}

TEST_CASE("a node's answer is read, a refusal with its own words",
          "[node_answer]") {
  const std::string uuid = "0123abcd-0000-4000-8000-000000000000";
  registration_challenge said;
  said.node = "arm";
  said.uuid = uuid;
  said.state = "independent";
  said.nonce = std::string(64, 'a');
  const auto read =
      answer_as<registration_challenge>(message_json(said).dump());
  REQUIRE(std::holds_alternative<registration_challenge>(read));
  CHECK(std::get<registration_challenge>(read).uuid == uuid);
  const failure no{error_code::unauthorized, "no site token", "", "give one"};
  CHECK(refusal(error_reply(no).dump()) == no);
  CHECK(refusal(R"({"type":"cell_list","cells":[]})").code
        == error_code::unknown_type);
}

} // namespace roscell::test
