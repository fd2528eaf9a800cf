#include "actors/edge/session/limits.hpp"
#include "actors/session/limits.hpp"
#include "actors/session/session_calls.hpp"
#include "actors/session/session_exchange.hpp"
#include "messages/session.hpp"
#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

#include <string>

namespace {

using namespace roscell;
using namespace std::chrono_literals;

/// Keeps how one call ended.
struct outcome {
  std::vector<caf::expected<json>> results;

  session_calls::on_result keep() {
    return [this](caf::expected<json> x) { results.push_back(std::move(x)); };
  }

  error_code code() const {
    return to_failure(results.at(0).error()).code;
  }
};

session_envelope reply_to(const std::optional<std::string>& request,
                          json body) {
  const auto id = read_envelope(request.value())->id;
  return *read_envelope(write_envelope(envelope_kind::reply, id, body));
}

const json departed = message_json(node_departed{});
const json departure = message_json(node_departure{"done"});

TEST_CASE("each reply goes to the call that it answers") {
  session_calls calls;
  outcome first;
  outcome second;
  auto a = calls.begin(departure, time_zero + 1s, first.keep());
  auto b = calls.begin(departure, time_zero + 1s, second.keep());
  CHECK(calls.finish(reply_to(b, departed)));
  CHECK(first.results.empty());
  REQUIRE(second.results.size() == 1);
  CHECK(*second.results[0] == departed);
  CHECK(calls.finish(reply_to(a, departed)));
  CHECK(first.results.size() == 1);
  CHECK(calls.pending() == 0);
}

TEST_CASE("a reply that comes again, or to nothing, is refused") {
  session_calls calls;
  outcome it;
  auto a = calls.begin(departure, time_zero + 1s, it.keep());
  const auto reply = reply_to(a, departed);
  CHECK(calls.finish(reply));
  CHECK_FALSE(calls.finish(reply));
  CHECK(it.results.size() == 1);
  auto unauthenticated_peer = reply;
  unauthenticated_peer.id = 4711;
  CHECK_FALSE(calls.finish(unauthenticated_peer));
}

TEST_CASE("an error reply becomes the error that it tells of") {
  session_calls calls;
  outcome it;
  auto a = calls.begin(departure, time_zero + 1s, it.keep());
  const failure why{error_code::engine_failed, "exit code 1", "/spec", "look",
                    R"({"log_tail":"oops"})"};
  calls.finish(reply_to(a, error_reply(why)));
  REQUIRE(it.results.size() == 1);
  CHECK(to_failure(it.results[0].error()) == why);
}

TEST_CASE("a reply that breaks its schema fails the call") {
  session_calls calls;
  outcome it;
  auto a = calls.begin(departure, time_zero + 1s, it.keep());
  calls.finish(reply_to(a, {{"type", "instance_deployed"}}));
  REQUIRE(it.results.size() == 1);
  CHECK(it.code() == error_code::internal);
}

TEST_CASE("a reply of another type fails the call") {
  const auto reply = reply_as<node_registered>(departed);
  REQUIRE_FALSE(reply);
  CHECK(to_failure(reply.error()).code == error_code::internal);
}

TEST_CASE("a call is given up at its deadline and not before") {
  session_calls calls;
  outcome early;
  outcome late;
  auto a = calls.begin(departure, time_zero + 1s, early.keep());
  calls.begin(departure, time_zero + 9s, late.keep());
  CHECK(calls.next_deadline() == time_zero + 1s);
  calls.expire(time_zero + 999ms);
  CHECK(early.results.empty());
  calls.expire(time_zero + 1s);
  REQUIRE(early.results.size() == 1);
  CHECK(early.code() == error_code::timeout);
  CHECK(late.results.empty());
  CHECK(calls.next_deadline() == time_zero + 9s);
  // Its reply comes too late.
  CHECK_FALSE(calls.finish(reply_to(a, departed)));
}

TEST_CASE("the end of a session fails every call at once") {
  session_calls calls;
  outcome first;
  outcome second;
  calls.begin(departure, time_zero + 1s, first.keep());
  calls.begin(departure, time_zero + 1s, second.keep());
  calls.fail_all("connection closed");
  REQUIRE(first.results.size() == 1);
  REQUIRE(second.results.size() == 1);
  CHECK(first.code() == error_code::unreachable);
  CHECK(calls.next_deadline() == session_calls::time_point::max());
}

TEST_CASE("the calls that wait are bounded in number and size") {
  session_calls calls;
  outcome it;
  for (size_t i = 0; i < limits::session::pending_calls; ++i)
    CHECK(calls.begin(departure, time_zero, [](const caf::expected<json>&) {}));
  CHECK_FALSE(calls.begin(departure, time_zero, it.keep()));
  CHECK(it.code() == error_code::conflict);
  session_calls others;
  outcome huge;
  const auto text = std::string(limits::session::frame_bytes, 'x');
  CHECK_FALSE(
      others.begin(message_json(node_departure{text}), time_zero, huge.keep()));
  CHECK(huge.code() == error_code::conflict);
  CHECK(others.pending() == 0);
}

TEST_CASE("a call may begin another one while it ends") {
  session_calls calls;
  outcome it;
  calls.begin(departure, time_zero, [&](const caf::expected<json>&) {
    calls.begin(departure, time_zero + 9s, it.keep());
  });
  calls.expire(time_zero);
  CHECK(it.results.empty());
  CHECK(calls.pending() == 1);
}

TEST_CASE("a frame that is no envelope is not read") {
  for (const auto* text :
       {"", "[]", "{}", "{\"type\":\"session_request\"}", "\xff\xfe",
        "{\"type\":\"session_hello\"}", "{\"type\":\"node_departed\"}",
        "{\"type\":\"session_reply\",\"id\":-1,\"body\":{\"type\":\"x\"}}",
        "{\"type\":\"session_notice\",\"body\":[]}"}) {
    CAPTURE(text);
    CHECK_FALSE(read_envelope(text));
  }
  CHECK_FALSE(read_envelope(std::string(100'000, '[')));
}

TEST_CASE("a frame with a bad body is read so that it can be refused") {
  const auto frame = read_envelope(
      R"({"type":"session_request","id":7,"body":{"type":"node_departure"}})");
  REQUIRE(frame);
  CHECK(frame->id == 7);
  REQUIRE(frame->refused);
  CHECK(frame->refused->code == error_code::schema_violation);
}

TEST_CASE("a request that comes twice is done once and answered twice") {
  std::vector<std::string> sent;
  session_exchange x{
      [&](std::string text) { sent.push_back(std::move(text)); }};
  const auto frame = write_envelope(envelope_kind::request, 5, departure);
  auto inquiry = x.receive(frame);
  REQUIRE(inquiry);
  CHECK(inquiry->id == 5u);
  CHECK(inquiry->type() == "node_departure");
  // While it is being done.
  CHECK_FALSE(x.receive(frame));
  CHECK(sent.empty());
  x.answer(5, departed);
  CHECK_FALSE(x.receive(frame));
  REQUIRE(sent.size() == 2);
  CHECK(sent[0] == sent[1]);
}

TEST_CASE("three bad frames make a session hopeless and two do not") {
  std::vector<std::string> sent;
  session_exchange x{
      [&](std::string text) { sent.push_back(std::move(text)); }};
  CHECK_FALSE(x.receive("nonsense"));
  CHECK_FALSE(
      x.receive(write_envelope(envelope_kind::request, 5, {{"type", "what"}})));
  CHECK_FALSE(x.hopeless());
  // Who asked is told why.
  REQUIRE(sent.size() == 1);
  const auto refusal = read_envelope(sent[0]);
  CHECK(refusal->id == 5);
  CHECK(failure_from(refusal->body).code == error_code::unknown_type);
  CHECK_FALSE(x.receive("nonsense"));
  CHECK(x.hopeless());
}

TEST_CASE("a reply that nobody waits for is not held against the peer") {
  session_exchange x{[](const std::string&) {}};
  for (uint64_t id = 1; id < 10; ++id)
    x.receive(write_envelope(envelope_kind::reply, id, departed));
  CHECK_FALSE(x.hopeless());
}

TEST_CASE("an answer too large for a frame becomes an error") {
  std::vector<std::string> sent;
  session_exchange x{
      [&](std::string text) { sent.push_back(std::move(text)); }};
  x.receive(write_envelope(envelope_kind::request, 5, departure));
  x.answer(5,
           message_json(log_excerpt{
               "a", std::string(limits::session::frame_bytes, 'x'), 0, false}));
  REQUIRE(sent.size() == 1);
  CHECK(failure_from(read_envelope(sent[0])->body).code
        == error_code::conflict);
}

using verdict_of = session_answers::verdict;

TEST_CASE("what was answered long ago is not done again") {
  session_answers answers;
  for (uint64_t id = 1; id <= limits::session::known_calls + 10; ++id) {
    REQUIRE(answers.admit(id).what == verdict_of::fresh);
    answers.record(id, "done");
  }
  CHECK(answers.admit(1).what == verdict_of::stale);
  CHECK(answers.admit(10).what == verdict_of::stale);
  CHECK(answers.admit(11).what == verdict_of::repeat);
}

TEST_CASE("an answer too large to be kept is not done again either") {
  session_answers answers;
  answers.admit(1);
  answers.record(1, std::string(limits::session::kept_answer_bytes + 1, 'x'));
  CHECK(answers.admit(1).what == verdict_of::stale);
}

TEST_CASE("more requests at once than can be remembered are refused") {
  session_answers answers;
  for (uint64_t id = 1; id <= limits::session::known_calls; ++id)
    REQUIRE(answers.admit(id).what == verdict_of::fresh);
  CHECK(answers.admit(1000).what == verdict_of::crowded);
  answers.record(7, "done");
  CHECK(answers.admit(1000).what == verdict_of::fresh);
}

} // namespace

namespace roscell {

namespace {

instance_verdict start_of(const std::string& instance, size_t bytes) {
  instance_verdict result{instance, verdict::start, {{}}};
  result.spec[0].instance = instance;
  result.spec[0].parameters = R"({"x":")" + std::string(bytes, 'y') + "\"}";
  return result;
}

size_t frame_of(const node_registered& answer) {
  return write_envelope(envelope_kind::reply, 1, message_json(answer)).size();
}

} // namespace

TEST_CASE("an answer to a registration with short starts stays whole") {
  node_registered answer;
  answer.verdicts = {start_of("t-a-1", 10), {"t-b-2", verdict::stop, {}}};
  CHECK(take_long_starts(answer).empty());
  CHECK(answer.verdicts.size() == 2);
}

TEST_CASE("starts that would make the answer longer than a frame follow it") {
  node_registered answer;
  for (int i = 0; i < 12; ++i)
    answer.verdicts.push_back(start_of("t-a-" + std::to_string(i), 100'000));
  answer.verdicts.push_back({"t-b-2", verdict::stop, {}});
  REQUIRE(frame_of(answer) > limits::session::frame_bytes);
  const auto later = take_long_starts(answer);
  CHECK(frame_of(answer) < limits::session::frame_bytes);
  CHECK(later.size() + answer.verdicts.size() == 13);
  CHECK(later.back().instance == "t-a-11");
  CHECK(answer.verdicts.back().what == verdict::stop);
}

} // namespace roscell
