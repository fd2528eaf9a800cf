#include "actors/edge/io/socket_address.hpp"

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/limits.hpp"

#include <boost/asio/steady_timer.hpp>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <future>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

namespace roscell {

namespace {

/// What a name server may be asked for.
constexpr size_t longest_name = 253;

constexpr std::string_view digits_and_dots = "0123456789.";
constexpr std::string_view name_letters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.-_";

bool is_host_name(const std::string& text) {
  return !text.empty() && text.size() <= longest_name && text.front() != '-'
         && text.front() != '.'
         && text.find_first_not_of(name_letters) == std::string::npos
         && text.find_first_not_of(digits_and_dots) != std::string::npos;
}

/// Host and port, whatever the host looks like.
std::optional<socket_address> split(std::string_view text,
                                    uint16_t default_port) {
  socket_address result{std::string{text.substr(0, text.find(':'))},
                        default_port};
  if (const auto colon = text.find(':'); colon != std::string_view::npos) {
    const auto digits = text.substr(colon + 1);
    const auto* end = digits.data() + digits.size();
    const auto read = std::from_chars(digits.data(), end, result.port);
    if (read.ec != std::errc{} || read.ptr != end)
      return std::nullopt;
  }
  if (result.port == 0)
    return std::nullopt;
  return result;
}

} // namespace

bool is_ipv4(const std::string& text) {
  in_addr ignored{};
  return inet_pton(AF_INET, text.c_str(), &ignored) == 1;
}

std::optional<socket_address> parse_socket_address(std::string_view text,
                                                   uint16_t default_port) {
  auto result = split(text, default_port);
  if (result && is_ipv4(result->address))
    return result;
  return std::nullopt;
}

std::optional<socket_address> parse_host_address(std::string_view text,
                                                 uint16_t default_port) {
  auto result = split(text, default_port);
  if (result && (is_ipv4(result->address) || is_host_name(result->address)))
    return result;
  return std::nullopt;
}

std::string to_string(const socket_address& x) {
  return x.address + ":" + std::to_string(x.port);
}

namespace {

using answer = edge_result<std::string>;

std::atomic<size_t> lookups{0};

edge_error no_such_host(const std::string& host, const std::string& why) {
  return {error_code::unreachable,
          "the name '" + host + "' does not resolve: " + why,
          "correct the name, or give the IPv4 address"};
}

edge_error no_answer(const std::string& host) {
  return {error_code::timeout,
          "the name '" + host + "' does not resolve: no name server answers",
          "check the name server, or give the IPv4 address"};
}

/// Asks and waits, for as long as the system likes.
answer resolve(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int code = getaddrinfo(host.c_str(), nullptr, &hints, &found))
    return no_such_host(host, gai_strerror(code));
  sockaddr_in first{};
  std::copy_n(reinterpret_cast<const char*>(found->ai_addr), sizeof(first),
              reinterpret_cast<char*>(&first));
  freeaddrinfo(found);
  std::array<char, INET_ADDRSTRLEN> text{};
  return std::string{
      inet_ntop(AF_INET, &first.sin_addr, text.data(), text.size())};
}

/// One of the lookups that there may be at a time, until it is let go.
class lookup_turn {
public:
  lookup_turn() : is_had_(lookups.fetch_add(1) < limits::membership::lookups) {}

  ~lookup_turn() {
    lookups.fetch_sub(1);
  }

  lookup_turn(const lookup_turn&) = delete;
  lookup_turn& operator=(const lookup_turn&) = delete;

  bool is_had() const {
    return is_had_;
  }

private:
  const bool is_had_;
};

edge_error too_many(const std::string& host) {
  return {error_code::conflict,
          "the name '" + host + "' is not looked up: "
              + std::to_string(limits::membership::lookups)
              + " others have no answer yet",
          "check the name server, or give the IPv4 address"};
}

edge_error no_thread(const std::string& host, const std::string& why) {
  return {error_code::conflict,
          "the name '" + host
              + "' is not looked up: no thread can be had: " + why,
          "give the IPv4 address, or raise the limit of processes: ulimit -u"};
}

/// Has a thread of its own resolve the name: nothing else can take a call back
/// that waits for a dead name server. The thread owns all that it uses, so that
/// nobody has to wait for it. Tells why it does not.
std::optional<edge_error> resolve_apart(const std::string& host,
                                        std::function<void(answer)> done) {
  auto turn = std::make_shared<lookup_turn>();
  if (!turn->is_had())
    return too_many(host);
  try {
    std::thread{[host, done = std::move(done), turn = std::move(turn)] {
      done(resolve(host));
    }}.detach();
  } catch (const std::system_error& why) {
    return no_thread(host, why.code().message());
  }
  return std::nullopt;
}

/// One question that the io thread waits for. Io thread only.
class host_question : public io_component,
                      public std::enable_shared_from_this<host_question> {
public:
  host_question(std::shared_ptr<io_core> core, std::function<void(answer)> done)
      : core_(std::move(core)), done_(std::move(done)),
        timer_(core_->context()) {
    // nop
  }

  void run(const std::string& host, std::chrono::milliseconds limit) {
    core_->adopt(shared_from_this());
    timer_.expires_after(limit);
    timer_.async_wait(
        [self = shared_from_this(), host](const boost::system::error_code& ec) {
          if (!ec)
            self->finish(no_answer(host));
        });
    // The thread may outlive the node, but keeps nothing of it alive.
    auto report = [core = std::weak_ptr<io_core>{core_},
                   self = weak_from_this()](const answer& x) {
      if (const auto loop = core.lock())
        loop->post([self, x] {
          if (const auto question = self.lock())
            question->finish(x);
        });
    };
    if (auto why = resolve_apart(host, std::move(report)))
      finish(*std::move(why));
  }

  void on_io_stop() override {
    finish(edge_error{error_code::unreachable, "the node stops", ""});
  }

private:
  void finish(const answer& x) {
    if (std::exchange(over_, true))
      return;
    const auto self = shared_from_this();
    timer_.cancel();
    core_->release(this);
    core_->guarded([&] { done_(x); });
  }

  std::shared_ptr<io_core> core_;
  std::function<void(answer)> done_;
  boost::asio::steady_timer timer_;
  bool over_ = false;
};

} // namespace

void look_up_host(const std::shared_ptr<io_core>& core, const std::string& host,
                  std::chrono::milliseconds limit,
                  std::function<void(edge_result<std::string>)> done) {
  core->post([core, host, limit, done = std::move(done)]() mutable {
    if (is_ipv4(host))
      return core->guarded([&] { done(host); });
    std::make_shared<host_question>(core, std::move(done))->run(host, limit);
  });
}

edge_result<std::string> await_host(const std::string& host,
                                    std::chrono::milliseconds limit) {
  if (is_ipv4(host))
    return host;
  const auto result = std::make_shared<std::promise<answer>>();
  auto future = result->get_future();
  if (auto why = resolve_apart(
          host, [result](answer x) { result->set_value(std::move(x)); }))
    return *std::move(why);
  if (future.wait_for(limit) != std::future_status::ready)
    return no_answer(host);
  return future.get();
}

resolved_hosts await_hosts(const std::vector<std::string>& hosts,
                           std::chrono::milliseconds limit) {
  using clock = std::chrono::steady_clock;
  const auto deadline = clock::now() + limit;
  resolved_hosts result;
  for (const auto& host : hosts) {
    const auto colon = std::min(host.find(':'), host.size());
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - clock::now());
    const auto found = await_host(host.substr(0, colon),
                                  std::max(left, std::chrono::milliseconds{0}));
    if (const auto* why = std::get_if<edge_error>(&found))
      result.problem += (result.problem.empty() ? "" : "; ") + why->message;
    else
      result.addresses.push_back(std::get<std::string>(found)
                                 + host.substr(colon));
  }
  return result;
}

} // namespace roscell
