#include "test/actors/edge/session/session_fixture.hpp"

namespace roscell::test::wire {

namespace {

using action = traffic_verdict::action;

/// A filter that does something to frames with a certain text in one
/// direction, and counts what it sees.
session_options with_filter(traffic_direction where, const std::string& what,
                            traffic_verdict verdict) {
  session_options result;
  result.filter = [=](traffic_direction direction, std::string_view text) {
    return direction == where && text == what ? verdict : traffic_verdict{};
  };
  return result;
}

traffic_verdict verdict(action what, std::chrono::milliseconds delay = 0ms,
                        unsigned times = 1) {
  return {what, delay, times};
}

constexpr auto outgoing = traffic_direction::outgoing;
constexpr auto incoming = traffic_direction::incoming;

} // namespace

TEST_CASE("a filter can lose frames in either direction") {
  for (const auto direction : {outgoing, incoming}) {
    session_pair pair{with_filter(direction, "lost", verdict(action::drop))};
    pair.joiner.link->send("lost");
    pair.joiner.link->send("kept");
    CHECK(pair.at_acceptor.frames.take() == "kept");
  }
}

TEST_CASE("lost frames take no room from those that come after") {
  session_options options;
  options.max_undone_frames = 2;
  options.max_queue_bytes = 1000;
  options.filter = [](traffic_direction direction, std::string_view text) {
    return direction == incoming && text != "end" ? verdict(action::drop)
                                                  : traffic_verdict{};
  };
  session_pair pair{options};
  for (int i = 0; i < 100; ++i) {
    REQUIRE(pair.joiner.link->send(std::string(100, 'x')));
    settle(pair.io);
  }
  pair.joiner.link->send("end");
  CHECK(pair.at_acceptor.frames.take() == "end");
}

TEST_CASE("a filter can repeat frames") {
  for (const auto direction : {outgoing, incoming}) {
    session_pair pair{
        with_filter(direction, "twice", verdict(action::repeat, 0ms, 2))};
    pair.joiner.link->send("twice");
    pair.joiner.link->send("once");
    CHECK(pair.at_acceptor.frames.take() == "twice");
    CHECK(pair.at_acceptor.frames.take() == "twice");
    CHECK(pair.at_acceptor.frames.take() == "once");
  }
}

TEST_CASE("a filter can make frames late, behind those that follow") {
  for (const auto direction : {outgoing, incoming}) {
    session_pair pair{
        with_filter(direction, "late", verdict(action::delay, 30ms))};
    pair.joiner.link->send("late");
    pair.joiner.link->send("early");
    CHECK(pair.at_acceptor.frames.take() == "early");
    CHECK(pair.at_acceptor.frames.take() == "late");
  }
}

TEST_CASE("a filter can cut the connection, which the peer sees at once") {
  for (const auto direction : {outgoing, incoming}) {
    session_pair pair{with_filter(direction, "cut", verdict(action::cut))};
    pair.joiner.link->send("cut");
    CHECK(pair.at_joiner.ends.take().why == session_end::cause::lost);
    CHECK(pair.at_acceptor.ends.take().why == session_end::cause::lost);
    CHECK(pair.at_acceptor.frames.size() == 0);
  }
}

TEST_CASE("a late frame of a session that is over is forgotten") {
  session_pair pair{
      with_filter(incoming, "late", verdict(action::delay, 20ms))};
  pair.joiner.link->send("late");
  pair.joiner.link->send("now");
  CHECK(pair.at_acceptor.frames.take() == "now");
  pair.joiner.link->close("bye");
  pair.at_acceptor.ends.take();
  pair.at_joiner.ends.take();
  // Two timers of the loop that are due later prove that it has passed.
  session_pair other{with_filter(outgoing, "x", verdict(action::delay, 40ms))};
  other.joiner.link->send("x");
  other.at_acceptor.frames.take();
  CHECK(pair.at_acceptor.frames.size() == 0);
}

} // namespace roscell::test::wire
