#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <functional>
#include <list>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

/// A container engine of which only the HTTP is real.
namespace roscell::test {

struct engine_call_seen {
  std::string method;
  std::string target;
  std::string body;
};

/// The server's end of one request. Lives as long as the engine.
class engine_caller {
public:
  explicit engine_caller(int fd) : fd_(fd) {
    // nop
  }

  ~engine_caller() {
    ::close(fd_);
  }

  engine_caller(const engine_caller&) = delete;
  engine_caller& operator=(const engine_caller&) = delete;

  void send(const std::string& bytes) const {
    ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  void reply(int status, const std::string& body) const {
    send("HTTP/1.1 " + std::to_string(status) + " x\r\nContent-Length: "
         + std::to_string(body.size()) + "\r\n\r\n" + body);
    hang_up();
  }

  /// Begins a reply of chunks.
  void open() const {
    send("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n");
  }

  void chunk(const std::string& bytes) const {
    char size[32];
    std::snprintf(size, sizeof size, "%zx\r\n", bytes.size());
    send(size + bytes + "\r\n");
  }

  void end() const {
    send("0\r\n\r\n");
    hang_up();
  }

  /// What was sent still arrives.
  void hang_up() const {
    ::shutdown(fd_, SHUT_RDWR);
  }

  /// One request, as far as the fake must understand it.
  engine_call_seen read() const {
    std::string text;
    size_t head = std::string::npos;
    while ((head = text.find("\r\n\r\n")) == std::string::npos)
      if (!receive(text))
        return {};
    constexpr const char* length = "Content-Length: ";
    const auto at = text.find(length);
    const auto size =
        at < head ? std::stoul(text.substr(at + std::strlen(length))) : 0;
    while (text.size() < head + 4 + size)
      if (!receive(text))
        return {};
    const auto space = text.find(' ');
    const auto end = text.find(' ', space + 1);
    return {text.substr(0, space), text.substr(space + 1, end - space - 1),
            text.substr(head + 4)};
  }

private:
  bool receive(std::string& text) const {
    char buffer[4096];
    const auto n = ::recv(fd_, buffer, sizeof buffer, 0);
    if (n > 0)
      text.append(buffer, static_cast<size_t>(n));
    return n > 0;
  }

  int fd_;
};

/// Calls `handle` on a thread of its own for each request.
class fake_engine {
public:
  using handler = std::function<void(engine_caller&, const engine_call_seen&)>;

  fake_engine(std::string path, handler handle)
      : path_(std::move(path)), handle_(std::move(handle)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_.copy(address.sun_path, sizeof address.sun_path - 1);
    fd_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address)
            != 0
        || ::listen(fd_, 64) != 0)
      throw std::runtime_error{"no fake engine on " + path_};
    thread_ = std::thread{[this] { accept_all(); }};
  }

  ~fake_engine() {
    ::shutdown(fd_, SHUT_RDWR);
    thread_.join();
    ::close(fd_);
    ::unlink(path_.c_str());
    for (auto& x : callers_)
      x.hang_up();
    for (auto& x : threads_)
      x.join();
  }

  fake_engine(const fake_engine&) = delete;
  fake_engine& operator=(const fake_engine&) = delete;

private:
  void accept_all() {
    for (;;) {
      const int fd = ::accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC);
      if (fd < 0)
        return;
      auto& caller = callers_.emplace_back(fd);
      threads_.emplace_back([this, &caller] {
        const auto request = caller.read();
        if (!request.method.empty())
          handle_(caller, request);
      });
    }
  }

  std::string path_;
  handler handle_;
  int fd_ = -1;
  std::thread thread_;
  std::list<engine_caller> callers_; ///< Touched by `thread_`, then the end.
  std::list<std::thread> threads_;
};

} // namespace roscell::test
