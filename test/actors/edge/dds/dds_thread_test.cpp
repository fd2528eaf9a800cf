#include "actors/edge/dds/dds_thread.hpp"

#include "actors/edge/dds/discovery_transport.hpp"

#include <catch2/catch.hpp>

#include <sys/socket.h>

#include <atomic>
#include <condition_variable>
#include <future>
#include <string>
#include <vector>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

constexpr const char* here = "127.0.0.1";

udp_socket socket_here() {
  return std::get<udp_socket>(udp_socket::bind(here, 0));
}

std::uint16_t port_of(const udp_socket& x) {
  return ntohs(x.local().sin_port);
}

std::uint16_t unused_port() {
  return port_of(socket_here());
}

void send_text_to(std::uint16_t port, const std::string& text) {
  const auto socket = socket_here();
  const auto to = *to_socket_address(here, port);
  sendto(socket.fd(), text.data(), text.size(), 0,
         reinterpret_cast<const sockaddr*>(&to), sizeof(to));
}

/// What was heard; the thread adds to it.
class heard_texts {
public:
  dds_thread::on_datagram listener() {
    return [this](std::uint8_t* bytes, std::size_t size, const sockaddr_in&) {
      const std::lock_guard lock{mutex_};
      texts_.emplace_back(bytes, bytes + size);
      changed_.notify_all();
    };
  }

  /// The first `count`, fewer if they do not come.
  std::vector<std::string> wait_for(std::size_t count) {
    std::unique_lock lock{mutex_};
    changed_.wait_for(lock, 20s, [&] { return texts_.size() >= count; });
    return texts_;
  }

private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> texts_;
};

using texts = std::vector<std::string>;

} // namespace

TEST_CASE("one thread hears at all sockets, each in its order",
          "[dds_thread]") {
  const auto thread = dds_thread::shared();
  CHECK(thread == dds_thread::shared());
  heard_texts first;
  heard_texts second;
  auto a = socket_here();
  auto b = socket_here();
  const auto to_a = port_of(a);
  const auto to_b = port_of(b);
  const auto x = thread->listen(std::move(a), 100, first.listener());
  const auto y = thread->listen(std::move(b), 100, second.listener());
  for (const auto* text : {"1", "2", "3"}) {
    send_text_to(to_a, text);
    send_text_to(to_b, std::string{"b"} + text);
  }
  CHECK(first.wait_for(3) == texts{"1", "2", "3"});
  CHECK(second.wait_for(3) == texts{"b1", "b2", "b3"});
}

TEST_CASE("datagrams that are empty or too long are not heard",
          "[dds_thread]") {
  heard_texts heard;
  auto socket = socket_here();
  const auto port = port_of(socket);
  const auto x =
      dds_thread::shared()->listen(std::move(socket), 4, heard.listener());
  for (const auto* text : {"", "12345", "1234"})
    send_text_to(port, text);
  CHECK(heard.wait_for(1) == texts{"1234"});
}

TEST_CASE("who does not listen any more is not called, and was waited for",
          "[dds_thread]") {
  const auto thread = dds_thread::shared();
  auto socket = socket_here();
  const auto port = port_of(socket);
  std::promise<void> begun;
  std::promise<void> go_on;
  std::atomic<bool> ended{false};
  auto x = thread->listen(std::move(socket), 100, [&](auto*, auto, auto&) {
    begun.set_value();
    go_on.get_future().wait();
    ended = true;
  });
  send_text_to(port, "1");
  send_text_to(port, "2");
  begun.get_future().wait();
  auto closing = std::async(std::launch::async, [&] { x.reset(); });
  CHECK(closing.wait_for(50ms) == std::future_status::timeout);
  go_on.set_value();
  closing.get();
  CHECK(ended);
}

TEST_CASE("a timer rings once at the time that was asked for last",
          "[dds_thread]") {
  std::promise<dds_thread::clock::time_point> rung;
  std::atomic<int> rings{0};
  const auto timer = dds_thread::shared()->make_timer([&] {
    if (++rings == 1)
      rung.set_value(dds_thread::clock::now());
  });
  const auto due = dds_thread::clock::now() + 30ms;
  timer->call_at(due + 1h);
  timer->call_at(due);
  auto at = rung.get_future();
  REQUIRE(at.wait_for(20s) == std::future_status::ready);
  CHECK(at.get() >= due);
  CHECK(rings == 1);
}

TEST_CASE("a timer may be asked again, or ended, by what it calls",
          "[dds_thread]") {
  std::promise<void> over;
  int rings = 0;
  std::unique_ptr<dds_thread::entry> timer;
  const auto thread = dds_thread::shared();
  timer = thread->make_timer([&] {
    if (++rings < 3)
      return timer->call_at(dds_thread::clock::now() + 1ms);
    auto* const reported = &over;
    timer.reset();
    reported->set_value();
  });
  timer->call_at(dds_thread::clock::now());
  REQUIRE(over.get_future().wait_for(20s) == std::future_status::ready);
  CHECK(rings == 3);
}

TEST_CASE("an inlet opens all of its ears at a port, or none", "[dds_thread]") {
  const auto port = unused_port();
  heard_texts heard;
  datagram_inlet inlet{{here, true, 100, 0}};
  CHECK_FALSE(inlet.is_open(port));
  REQUIRE(inlet.open(port, heard.listener(), heard.listener()));
  CHECK(inlet.is_open(port));
  datagram_inlet other{{here, true, 100, 0}};
  CHECK_FALSE(other.open(port, heard.listener(), heard.listener()));
  CHECK_FALSE(other.is_open(port));
  send_text_to(port, "once");
  CHECK(heard.wait_for(1) == texts{"once"});
  CHECK(inlet.close(port));
  CHECK_FALSE(inlet.close(port));
  CHECK(other.open(port, heard.listener(), heard.listener()));
}

TEST_CASE("inlets share the port of a group, and each hears what comes",
          "[dds_thread]") {
  constexpr const char* group = "239.255.71.9";
  const auto port = unused_port();
  heard_texts first;
  heard_texts second;
  datagram_inlet a{{here, false, 100, 0}};
  datagram_inlet b{{here, false, 100, 0}};
  REQUIRE(a.open_group(group, port, first.listener()));
  REQUIRE(b.open_group(group, port, second.listener()));
  const auto socket = socket_here();
  const auto from = socket.local().sin_addr;
  setsockopt(socket.fd(), IPPROTO_IP, IP_MULTICAST_IF, &from, sizeof(from));
  sockaddr_in to = *to_socket_address(here, port);
  to.sin_addr.s_addr = htonl(0xefff4709);
  REQUIRE(sendto(socket.fd(), "all", 3, 0,
                 reinterpret_cast<const sockaddr*>(&to), sizeof(to))
          == 3);
  CHECK(first.wait_for(1) == texts{"all"});
  CHECK(second.wait_for(1) == texts{"all"});
}
