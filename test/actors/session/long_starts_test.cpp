#include "actors/edge/session/limits.hpp"
#include "actors/session/long_starts.hpp"

#include "actors/session/session_envelope.hpp"

#include <catch2/catch.hpp>

#include <string>

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
