#include "embedding/skills/frame_inbox.hpp"

#include <catch2/catch.hpp>

#include <thread>

using namespace roscell;
using namespace roscell::embedding;

namespace {

shared_frame frame_of(const std::string& text) {
  engine::frame result;
  result.payload = text;
  return std::make_shared<const engine::frame>(std::move(result));
}

std::string text_of(const std::optional<skill_frame>& x) {
  return x ? x->data->payload : "none";
}

} // namespace

TEST_CASE("an inbox wakes once until it has been found empty") {
  int wakes = 0;
  frame_inbox inbox{1, {}, [&] { ++wakes; }};
  inbox.push(0, frame_of("a"), engine::when_full::drop_oldest);
  inbox.push(0, frame_of("b"), engine::when_full::drop_oldest);
  CHECK(wakes == 1);
  CHECK(text_of(inbox.pop()) == "a");
  CHECK(text_of(inbox.pop()) == "b");
  CHECK(text_of(inbox.pop()) == "none");
  inbox.push(0, frame_of("c"), engine::when_full::drop_oldest);
  CHECK(wakes == 2);
}

TEST_CASE("a full lane drops its oldest frame and no other lane's") {
  frame_inbox inbox{2, {2, 100}, [] {}};
  inbox.push(1, frame_of("slow"), engine::when_full::drop_oldest);
  for (const char* text : {"a", "b", "c"})
    inbox.push(0, frame_of(text), engine::when_full::drop_oldest);
  CHECK(inbox.dropped() == 1);
  const auto first = inbox.pop();
  CHECK(text_of(first) == "b");
  // A gap in the numbers tells of what was dropped.
  CHECK(first->sequence == 1);
  CHECK(text_of(inbox.pop()) == "slow");
  CHECK(text_of(inbox.pop()) == "c");
}

TEST_CASE("a lane is bounded in bytes, too, but takes any frame when empty") {
  frame_inbox inbox{1, {8, 10}, [] {}};
  inbox.push(0, frame_of("twelve bytes"), engine::when_full::drop_oldest);
  CHECK(inbox.dropped() == 0);
  inbox.push(0, frame_of("six by"), engine::when_full::drop_oldest);
  CHECK(inbox.dropped() == 1);
  inbox.push(0, frame_of("four"), engine::when_full::drop_oldest);
  CHECK(inbox.dropped() == 1);
  inbox.push(0, frame_of("1"), engine::when_full::drop_oldest);
  CHECK(inbox.dropped() == 2);
  CHECK(text_of(inbox.pop()) == "four");
  CHECK(text_of(inbox.pop()) == "1");
}

TEST_CASE("who may not lose frames waits until there is room, or the end") {
  frame_inbox inbox{1, {1, 100}, [] {}};
  inbox.push(0, frame_of("a"), engine::when_full::wait);
  bool second = false;
  bool third = true;
  std::thread writer{[&] {
    second = inbox.push(0, frame_of("b"), engine::when_full::wait);
    third = inbox.push(0, frame_of("c"), engine::when_full::wait);
  }};
  CHECK(text_of(inbox.pop()) == "a");
  for (auto next = inbox.pop(); !next; next = inbox.pop())
    std::this_thread::yield();
  inbox.close();
  writer.join();
  CHECK(second);
  // Whether it had come in before the end or not, it is not handed out.
  static_cast<void>(third);
  CHECK(text_of(inbox.pop()) == "none");
}

TEST_CASE("a hub passes one frame to all readers of a stream without a copy") {
  frame_hub hub;
  const auto one = std::make_shared<frame_inbox>(1, inbox_limits{}, [] {});
  auto two = std::make_shared<frame_inbox>(2, inbox_limits{}, [] {});
  hub.subscribe("/a", one, 0);
  hub.subscribe("/a", two, 1);
  const auto sent = frame_of("x");
  hub.publish("/a", sent);
  hub.publish("/b", frame_of("y"));
  CHECK(one->pop()->data == sent);
  const auto seen = two->pop();
  CHECK(seen->data == sent);
  CHECK(seen->port == 1);
  CHECK_FALSE(two->pop());
  // Who has ended is not kept alive by the hub.
  std::weak_ptr<frame_inbox> gone = two;
  two.reset();
  CHECK(gone.expired());
  hub.publish("/a", sent);
  CHECK(one->pop()->data == sent);
}
