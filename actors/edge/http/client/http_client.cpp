#include "actors/edge/http/client/http_client.hpp"

#include "actors/edge/http/client/http_exchange.hpp"
#include "actors/edge/http/limits.hpp"
#include "actors/edge/io/plain_text.hpp"

#include <boost/asio/posix/stream_descriptor.hpp>

#include <array>
#include <cerrno>
#include <exception>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// The IPv4 address of a host.
edge_result<std::string> resolve(const http_endpoint& to) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int why = ::getaddrinfo(to.address.c_str(), nullptr, &hints, &found);
  if (why != 0)
    return edge_error{error_code::unreachable,
                      "cannot reach " + to.name() + ": " + ::gai_strerror(why),
                      "is the name right?"};
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> list{
      found, &::freeaddrinfo};
  const auto* address = reinterpret_cast<const sockaddr_in*>(list->ai_addr);
  std::array<char, INET_ADDRSTRLEN> text{};
  ::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
  return std::string{text.data()};
}

/// Runs one call to its end on a loop of its own.
class waiting_call {
public:
  explicit waiting_call(const http_client::options& how)
      : core_(std::make_shared<io_core>(edge_log{})), proof_(how.proof),
        cancelled_(core_->context()) {
    if (how.cancel != nullptr)
      cancelled_.assign(::fcntl(how.cancel->fd(), F_DUPFD_CLOEXEC, 0));
  }

  http_outcome run(http_call what, http_callbacks calls) {
    http_outcome result;
    calls.on_end = [&](http_outcome outcome) {
      result = std::move(outcome);
      core_->stop();
    };
    const auto probe = make_probe(what);
    if (probe && calls.on_bytes)
      calls.on_bytes = [probe, pass = std::move(calls.on_bytes)](auto bytes) {
        probe->wait();
        return pass(bytes);
      };
    auto exchange = std::make_shared<http_exchange>(core_, std::move(what),
                                                    std::move(calls));
    watched_ = exchange;
    if (cancelled_.is_open())
      cancelled_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                            [this](boost::system::error_code ec) {
                              if (!ec)
                                end_with(http_failure::kind::cancelled);
                            });
    core_->post([exchange = std::move(exchange)] { exchange->start(); });
    if (probe)
      core_->post([probe] { probe->wait(); });
    core_->run();
    return result;
  }

private:
  /// Null if nobody wants a proof of life.
  std::shared_ptr<life_probe> make_probe(const http_call& what) {
    if (!proof_)
      return nullptr;
    http_call question;
    question.to = what.to;
    question.target = proof_->path;
    question.timeout = proof_->limit;
    return std::make_shared<life_probe>(
        core_, std::move(question), proof_->pause,
        [this] { end_with(http_failure::kind::silent); });
  }

  void end_with(http_failure::kind why) {
    if (const auto exchange = watched_.lock())
      exchange->finish(http_failure{why, {}, 0});
  }

  std::shared_ptr<io_core> core_;
  const std::optional<http_client::proof_of_life> proof_;
  std::weak_ptr<http_exchange> watched_;
  boost::asio::posix::stream_descriptor cancelled_;
};

/// The lines of a stream, for a receiver that may throw.
class line_reader {
public:
  explicit line_reader(const std::function<bool(std::string_view)>& on_line)
      : lines_(limits::http::client_line_bytes, [this, &on_line](auto line) {
          return pass_line(on_line, line);
        }) {
    // nop
  }

  bool take(std::string_view bytes) {
    enough_ = !lines_.take(bytes);
    return !enough_ && !lines_.too_long();
  }

  /// After the end of the stream.
  std::optional<edge_error> finish() {
    if (!thrown_ && !enough_ && lines_.too_long())
      return edge_error{error_code::unreachable, "a line has no end", ""};
    if (!enough_)
      lines_.finish();
    if (thrown_)
      std::rethrow_exception(thrown_);
    return std::nullopt;
  }

private:
  bool pass_line(const std::function<bool(std::string_view)>& on_line,
                 std::string_view line) {
    try {
      return on_line(line);
    } catch (...) {
      thrown_ = std::current_exception();
      return false;
    }
  }

  std::exception_ptr thrown_;
  bool enough_ = false;
  line_splitter lines_;
};

} // namespace

http_cancel::http_cancel() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0)
    throw std::system_error(errno, std::generic_category(), "eventfd");
}

http_cancel::~http_cancel() {
  ::close(fd_);
}

void http_cancel::cancel() const {
  const uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(fd_, &one, sizeof one);
}

http_client::options::options() : timeout{limits::http::client_timeout} {
  // nop
}

http_client::http_client(http_endpoint to) : to_(std::move(to)) {
  // nop
}

http_call http_client::call_to(const std::string& path,
                               const options& how) const {
  http_call result;
  result.to = to_;
  result.target = path;
  result.headers = how.headers;
  result.timeout = how.timeout;
  result.max_reply_bytes = limits::http::client_reply_bytes;
  return result;
}

edge_result<http_reply> http_client::run(const http_call& what,
                                         const options& how,
                                         http_callbacks calls) const {
  auto call = what;
  if (to_.socket_path.empty()) {
    auto address = resolve(to_);
    if (auto* why = std::get_if<edge_error>(&address))
      return std::move(*why);
    call.to.address = std::get<std::string>(std::move(address));
  }
  auto outcome = waiting_call{how}.run(std::move(call), std::move(calls));
  const auto* why = std::get_if<http_failure>(&outcome);
  if (why != nullptr && why->what == http_failure::kind::cut_off
      && how.when_cut_off)
    return *how.when_cut_off;
  return to_edge_result(std::move(outcome), what);
}

edge_result<http_reply> http_client::request(const std::string& method,
                                             const std::string& path,
                                             const std::string& body,
                                             const options& how) const {
  auto what = call_to(path, how);
  what.method = method;
  what.body = body;
  return run(what, how, {});
}

edge_result<http_reply>
http_client::follow(const std::string& path,
                    const std::function<bool(std::string_view line)>& on_line,
                    const options& how) const {
  auto what = call_to(path, how);
  what.endless = true;
  line_reader reader{on_line};
  http_callbacks calls;
  calls.on_bytes = [&](std::string_view bytes) { return reader.take(bytes); };
  auto result = run(what, how, std::move(calls));
  if (std::holds_alternative<edge_error>(result))
    return result;
  if (auto why = reader.finish())
    return std::move(*why);
  return result;
}

edge_result<http_reply>
http_client::download(const std::string& path,
                      const std::function<bool(std::string_view)>& on_bytes,
                      const options& how) const {
  http_callbacks calls;
  calls.on_bytes = on_bytes;
  return run(call_to(path, how), how, std::move(calls));
}

edge_result<http_reply> http_client::send_file(const std::string& path,
                                               const fs::path& file,
                                               const options& how) const {
  auto what = call_to(path, how);
  what.method = "POST";
  what.file = file;
  return run(what, how, {});
}

} // namespace roscell
