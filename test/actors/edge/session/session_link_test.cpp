#include "actors/edge/session/session_link.hpp"
#include "test/actors/edge/session/session_fixture.hpp"

#include <atomic>

namespace roscell::test::wire {

TEST_CASE("frames pass in both directions and in order") {
  session_pair pair;
  for (int i = 0; i < 50; ++i) {
    CHECK(pair.joiner.link->send("to acceptor " + std::to_string(i)));
    CHECK(pair.acceptor.link->send("to joiner " + std::to_string(i)));
  }
  for (int i = 0; i < 50; ++i) {
    CHECK(pair.at_acceptor.frames.take() == "to acceptor " + std::to_string(i));
    CHECK(pair.at_joiner.frames.take() == "to joiner " + std::to_string(i));
  }
}

TEST_CASE("both sides know who the other one is") {
  session_pair pair;
  CHECK(pair.acceptor.peer.node == "robot-1");
  CHECK(pair.acceptor.peer.uuid == "0a1b");
  CHECK(pair.acceptor.peer.number == 7);
  CHECK(pair.acceptor.peer.address == "127.0.0.1");
  CHECK(pair.acceptor.peer.version == session_version);
  CHECK(pair.acceptor.peer.role.empty());
  CHECK(pair.joiner.peer.node == "base");
  CHECK(pair.joiner.peer.cell == "kitchen");
  CHECK(pair.joiner.peer.number == 3);
  CHECK(pair.joiner.agreement.session == pair.acceptor.agreement.session);
}

TEST_CASE("an acceptor knows a coordinator by its role") {
  acceptor_fixture acceptor;
  auto joined =
      acceptor.join({}, site_token, {"hall-1", "0a1c", 5, "coordinator"});
  REQUIRE(std::holds_alternative<established_session>(joined));
  CHECK(std::get<established_session>(joined).peer.role.empty());
  const auto session = acceptor.sessions.take();
  CHECK(session.peer.role == coordinator_role);
  CHECK(session.peer.number == 5);
  acceptor.io.stop();
}

TEST_CASE("what was sent before the other side started is not lost") {
  session_pair pair{{}, false};
  pair.joiner.link->send("early");
  pair.joiner.link->close("done already");
  settle(pair.io);
  pair.start();
  CHECK(pair.at_acceptor.frames.take() == "early");
  CHECK(pair.at_acceptor.ends.take().reason == "done already");
}

TEST_CASE("a session is closed with a reason that both sides get once") {
  session_pair pair;
  pair.joiner.link->send("last words");
  pair.joiner.link->close("leaving for\nlunch");
  pair.joiner.link->close("again");
  CHECK(pair.at_acceptor.frames.take() == "last words");
  const auto there = pair.at_acceptor.ends.take();
  CHECK(there.why == session_end::cause::closed_there);
  CHECK(there.reason == "leaving for?lunch");
  const auto here = pair.at_joiner.ends.take();
  CHECK(here.why == session_end::cause::closed_here);
  CHECK_FALSE(pair.joiner.link->send("too late"));
  CHECK_FALSE(pair.acceptor.link->send("too late"));
  pair.acceptor.link->close("me too");
  settle(pair.io);
  CHECK(pair.at_acceptor.ends.size() == 0);
  CHECK(pair.at_joiner.ends.size() == 0);
}

TEST_CASE("letting go of a link closes the session") {
  session_pair pair;
  pair.joiner.link.reset();
  CHECK(pair.at_acceptor.ends.take().reason
        == "the owner let go of the session");
  CHECK(pair.at_joiner.ends.take().why == session_end::cause::closed_here);
}

TEST_CASE("letting go of a link that was never started closes it, too") {
  session_pair pair{{}, false};
  pair.acceptor.link->start(pair.at_acceptor.callbacks());
  pair.joiner.link.reset();
  CHECK(pair.at_acceptor.ends.take().why == session_end::cause::closed_there);
}

TEST_CASE("both sides may close at the same time, in full flow") {
  for (int round = 0; round < 20; ++round) {
    session_pair pair;
    for (int i = 0; i < 30; ++i) {
      pair.joiner.link->send(std::string(10'000, 'j'));
      pair.acceptor.link->send(std::string(10'000, 'a'));
    }
    pair.joiner.link->close("joiner closes");
    pair.acceptor.link->close("acceptor closes");
    pair.at_joiner.ends.take();
    pair.at_acceptor.ends.take();
    settle(pair.io);
    CHECK(pair.at_joiner.ends.size() == 0);
    CHECK(pair.at_acceptor.ends.size() == 0);
  }
}

TEST_CASE("a frame over the limit is not sent") {
  session_options options;
  options.max_frame_bytes = 1000;
  session_pair pair{options};
  CHECK_FALSE(pair.joiner.link->send(std::string(1001, 'x')));
  CHECK(pair.joiner.link->send(std::string(1000, 'x')));
  CHECK(pair.at_acceptor.frames.take().size() == 1000);
}

TEST_CASE("a frame over the limit that comes ends the session") {
  session_options small;
  small.max_frame_bytes = 1000;
  session_pair pair{small, true, session_options{}};
  CHECK(pair.joiner.link->send(std::string(1001, 'x')));
  const auto end = pair.at_acceptor.ends.take();
  CHECK(end.why == session_end::cause::violation);
  CHECK(end.reason.find("more than 1000 bytes") != std::string::npos);
  CHECK(pair.at_joiner.ends.take().why == session_end::cause::closed_there);
  CHECK(pair.at_acceptor.frames.size() == 0);
}

TEST_CASE("a reader that is not done with its frames gets no more of them") {
  session_options options;
  options.max_undone_frames = 3;
  session_pair pair{options};
  pair.at_acceptor.keep_undone = true;
  for (int i = 0; i < 10; ++i)
    pair.joiner.link->send(std::to_string(i));
  for (int i = 0; i < 3; ++i)
    CHECK(pair.at_acceptor.frames.take() == std::to_string(i));
  // An answer that passes both ways proves that nothing else is on its way.
  pair.acceptor.link->send("ping");
  pair.at_joiner.frames.take();
  settle(pair.io);
  CHECK(pair.at_acceptor.frames.size() == 0);
  // Being done twice with one frame makes room for one frame only.
  const auto done = pair.at_acceptor.undone.take();
  done();
  done();
  CHECK(pair.at_acceptor.frames.take() == "3");
  settle(pair.io);
  CHECK(pair.at_acceptor.frames.size() == 0);
  pair.at_acceptor.keep_undone = false;
  while (pair.at_acceptor.undone.size() > 0)
    pair.at_acceptor.undone.take();
  for (int i = 4; i < 10; ++i)
    CHECK(pair.at_acceptor.frames.take() == std::to_string(i));
}

TEST_CASE("a peer that reads nothing is given up, and memory stays bounded") {
  session_options options;
  options.max_queue_bytes = 1'000'000;
  session_pair pair{options};
  pair.at_acceptor.keep_undone = true;
  const std::string frame(100'000, 'x');
  size_t most = 0;
  while (pair.joiner.link->send(frame))
    most = std::max(most, pair.joiner.link->queued_bytes());
  CHECK(most <= options.max_queue_bytes);
  const auto end = pair.at_joiner.ends.take();
  CHECK(end.why == session_end::cause::too_slow);
  CHECK(end.reason == "the peer is too slow");
  CHECK(pair.at_acceptor.frames.size() <= options.max_undone_frames);
}

TEST_CASE("the end of the io thread ends its sessions") {
  session_pair pair;
  pair.io.stop();
  CHECK(pair.at_joiner.ends.take().why == session_end::cause::closed_here);
  CHECK(pair.at_acceptor.ends.take().why == session_end::cause::closed_here);
  pair.joiner.link->send("x");
  pair.joiner.link->close("x");
}

TEST_CASE("a callback that throws is logged and the session goes on") {
  session_pair pair{{}, false};
  auto callbacks = pair.at_acceptor.callbacks();
  callbacks.on_frame = [&pair](const std::string& text,
                               const std::function<void()>&) {
    pair.at_acceptor.frames.put(text);
    throw std::runtime_error("broken owner");
  };
  pair.acceptor.link->start(callbacks);
  pair.joiner.link->start(pair.at_joiner.callbacks());
  for (int i = 0; i < 20; ++i)
    pair.joiner.link->send("frame");
  for (int i = 0; i < 20; ++i)
    CHECK(pair.at_acceptor.frames.take() == "frame");
  CHECK(pair.log.take().find("broken owner") != std::string::npos);
}

TEST_CASE("callbacks that hold their own link do not keep it for ever") {
  session_pair pair{{}, false};
  const std::weak_ptr<session_link> watched = pair.joiner.link;
  auto callbacks = pair.at_joiner.callbacks();
  callbacks.on_frame = [held = pair.joiner.link](const std::string&,
                                                 const auto&) {};
  pair.joiner.link->start(std::move(callbacks));
  pair.acceptor.link->start(pair.at_acceptor.callbacks());
  pair.joiner.link.reset();
  CHECK_FALSE(watched.expired());
  pair.acceptor.link->close("bye");
  pair.at_joiner.ends.take();
  settle(pair.io);
  CHECK(watched.expired());
}

} // namespace roscell::test::wire
