#include "skills/engine/frame_queue.hpp"

#include "test/skills/files.hpp"

#include <catch2/catch.hpp>

#include <future>
#include <thread>

using namespace roscell::engine;

namespace {

frame make(const std::string& payload, std::size_t port = 0) {
  frame result;
  result.payload = payload;
  result.port = port;
  return result;
}

/// The payload of the next frame, or "closed".
std::string next(frame_queue& queue) {
  auto f = queue.pop();
  return f ? f->payload : "closed";
}

constexpr frame_queue::limits two_frames{2, 1000};

} // namespace

TEST_CASE("a full queue drops its oldest frame for a live input") {
  frame_queue queue{1, two_frames};
  for (const auto* payload : {"a", "b", "c", "d"})
    CHECK(queue.push(make(payload), when_full::drop_oldest));
  CHECK(queue.dropped(0) == 2);
  CHECK(next(queue) == "c");
  CHECK(next(queue) == "d");
}

TEST_CASE("a full queue holds a waiting input back and loses nothing") {
  frame_queue queue{1, two_frames};
  std::thread producer{[&] {
    for (auto i = 0; i < 1000; ++i)
      queue.push(make(std::to_string(i)), when_full::wait);
    queue.close();
  }};
  for (auto i = 0; i < 1000; ++i)
    REQUIRE(next(queue) == std::to_string(i));
  producer.join();
  CHECK(next(queue) == "closed");
  CHECK(queue.dropped(0) == 0);
}

TEST_CASE("an input that waits for room returns when the queue stops") {
  frame_queue queue{1, two_frames};
  queue.push(make("a"), when_full::wait);
  queue.push(make("b"), when_full::wait);
  auto third = std::async(std::launch::async, [&] {
    return queue.push(make("c"), when_full::wait);
  });
  queue.discard();
  REQUIRE(third.wait_for(roscell::test::patience) == std::future_status::ready);
  CHECK_FALSE(third.get());
}

TEST_CASE("a queue is bounded in bytes, but a large frame passes alone") {
  frame_queue queue{1, {100, 10}};
  CHECK(queue.push(make("12345678901234567890"), when_full::drop_oldest));
  CHECK(queue.dropped(0) == 0);
  CHECK(queue.push(make("123456"), when_full::drop_oldest));
  CHECK(queue.push(make("1234"), when_full::drop_oldest));
  CHECK(queue.dropped(0) == 1);
  CHECK(queue.push(make("1"), when_full::drop_oldest));
  CHECK(queue.dropped(0) == 2);
  CHECK(next(queue) == "1234");
  CHECK(next(queue) == "1");
}

TEST_CASE("inputs take turns, and none drops the frames of another") {
  frame_queue queue{2, two_frames};
  queue.push(make("slow", 1), when_full::drop_oldest);
  for (const auto* payload : {"a", "b", "c"})
    queue.push(make(payload, 0), when_full::drop_oldest);
  CHECK(next(queue) == "b");
  CHECK(next(queue) == "slow");
  CHECK(next(queue) == "c");
}

TEST_CASE("a closed queue hands out what it holds, a discarded one does not") {
  frame_queue closed{1, two_frames};
  closed.push(make("a"), when_full::wait);
  closed.close();
  CHECK_FALSE(closed.push(make("b"), when_full::drop_oldest));
  CHECK(next(closed) == "a");
  CHECK(next(closed) == "closed");
  frame_queue discarded{1, two_frames};
  discarded.push(make("a"), when_full::wait);
  discarded.discard();
  CHECK(next(discarded) == "closed");
  CHECK(discarded.dropped(0) == 0);
}

TEST_CASE("what is interposed is done by who takes frames, before the next "
          "one") {
  frame_queue queue{1, two_frames};
  queue.push(make("a"), when_full::wait);
  std::string done;
  queue.interpose([&] { done += "first "; });
  queue.interpose([&] { done += "second "; });
  CHECK(done.empty());
  CHECK(next(queue) == "a");
  CHECK(done == "second ");
}

TEST_CASE("what is interposed wakes who waits for a frame") {
  frame_queue queue{1, two_frames};
  std::promise<std::thread::id> doer;
  std::thread taker{[&] { next(queue); }};
  queue.interpose([&] { doer.set_value(std::this_thread::get_id()); });
  CHECK(doer.get_future().get() == taker.get_id());
  queue.close();
  taker.join();
}

TEST_CASE("nothing is interposed once a queue is closed") {
  frame_queue queue{1, two_frames};
  queue.close();
  queue.interpose([] { FAIL("it is done"); });
  CHECK(next(queue) == "closed");
}

TEST_CASE("frames that are dropped count for their input") {
  frame_queue queue{2, two_frames};
  for (const auto* payload : {"a", "b", "c"})
    queue.push(make(payload, 1), when_full::drop_oldest);
  CHECK(queue.dropped(0) == 0);
  CHECK(queue.dropped(1) == 1);
}
