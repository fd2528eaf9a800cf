#pragma once

#include "actors/edge/http/client/http_client.hpp"
#include "actors/edge/http/http_server.hpp"
#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Real sockets of one process on 127.0.0.1 and in scratch folders.
namespace roscell::test::wire {

using namespace std::chrono_literals;

/// Long enough for a loaded machine under sanitizers; only a failing test
/// ever waits for it.
inline constexpr std::chrono::seconds patience{30};

/// Hands values from the io thread to the thread of the test.
template <class T>
class inbox {
public:
  void put(T value) {
    const std::lock_guard guard{mutex_};
    values_.push_back(std::move(value));
    changed_.notify_all();
  }

  /// The next value; fails the test if none comes.
  T take() {
    std::unique_lock lock{mutex_};
    if (!changed_.wait_for(lock, patience, [this] { return !values_.empty(); }))
      throw std::runtime_error("the test waited in vain");
    auto result = std::move(values_.front());
    values_.pop_front();
    return result;
  }

  size_t size() const {
    const std::lock_guard guard{mutex_};
    return values_.size();
  }

private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> values_;
};

/// Waits until everything that was posted to the thread before has run.
void settle(io_thread& io);

/// A client that sends what no proper client would.
class raw_client {
public:
  /// `receive_bytes` bounds the kernel's buffer, where it is not 0.
  explicit raw_client(uint16_t port, int receive_bytes = 0);
  explicit raw_client(const std::string& socket_path);
  ~raw_client();

  raw_client(raw_client&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {
    // nop
  }

  raw_client(const raw_client&) = delete;
  raw_client& operator=(const raw_client&) = delete;

  /// False once the peer takes no more.
  bool send(std::string_view text);

  /// Sends as much of `text` as fits without waiting; its size.
  size_t send_some(std::string_view text);

  /// All until the peer closes.
  std::string read_to_end();

  /// Up to and with `mark`, or all if it closes before.
  std::string read_until(std::string_view mark);

  /// Whether there is something to read, the end included.
  bool is_readable() const;

  /// Whether the peer has closed by now.
  bool is_closed();

  void close();

  int fd() const {
    return fd_;
  }

private:
  int fd_ = -1;
};

/// The value of a result that must be one.
template <class T>
T expect(edge_result<T> result) {
  if (const auto* why = std::get_if<edge_error>(&result))
    throw std::runtime_error(to_string(why->code) + ": " + why->message);
  return std::get<T>(std::move(result));
}

/// The error of a result that must be one.
template <class T>
edge_error expect_error(const edge_result<T>& result) {
  const auto* why = std::get_if<edge_error>(&result);
  return why != nullptr ? *why : edge_error{error_code::internal, "none", ""};
}

inline constexpr const char* bearer = "the-bearer-token";

/// A server whose requests the test answers.
struct http_fixture {
  struct asked {
    http_request request;
    responder answer;
  };

  explicit http_fixture(http_limits limits = {}, bool with_socket = true);

  http_client tcp_client(std::string token = bearer) const;
  http_client local_client() const;
  std::string socket_path() const {
    return folder / "node.sock";
  }

  temp_folder folder;
  inbox<std::string> log;
  inbox<asked> requests; ///< Gets all but `/echo`, which answers at once.
  io_thread io{[this](const std::string& line) { log.put(line); }};
  std::unique_ptr<http_server> server;
};

/// A GET request with the bearer token.
std::string get(const std::string& path, const std::string& more = {});

} // namespace roscell::test::wire
