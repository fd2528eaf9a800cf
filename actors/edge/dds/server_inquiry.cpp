#include "actors/edge/dds/server_inquiry.hpp"

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/discovery_seeker.hpp"
#include "actors/edge/host/interfaces.hpp"

#include <atomic>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

namespace roscell {

namespace {

std::optional<edge_error> check(const server_inquiry_options& options) {
  if (to_socket_address(options.server_address, options.server_port)
      && options.server_port != 0)
    return std::nullopt;
  return edge_error{error_code::schema_violation,
                    "\"" + options.server_address.substr(0, 64) + ':'
                        + std::to_string(options.server_port)
                        + "\" is no IPv4 address and port",
                    ""};
}

edge_result<std::string> local_address(const server_inquiry_options& options) {
  if (options.address.empty())
    return local_address_towards(
        *to_socket_address(options.server_address, options.server_port));
  auto found = resolve_interface(options.address);
  if (auto* error = std::get_if<edge_error>(&found))
    return *error;
  return std::get<interface_address>(found).address;
}

} // namespace

class server_inquiry::impl {
public:
  impl(const server_inquiry_options& options, on_server_found callback)
      : callback_(std::move(callback)),
        seeker_(*to_socket_address(options.server_address, options.server_port),
                options.address, longest_pause),
        thread_([this] { run(); }) {}

  ~impl() {
    close();
  }

  void close() {
    closing_ = true;
    wake_.raise();
    if (thread_.joinable())
      thread_.join();
  }

private:
  void run() {
    while (!closing_)
      if (auto seen = seeker_.seek(wake_)) {
        report_change(*seen);
        wake_.wait(longest_pause);
      }
  }

  void report_change(const server_sighting& seen) {
    if (closing_ || known_ == seen.announcement)
      return;
    known_ = seen.announcement;
    callback_(seen);
  }

  const on_server_found callback_;
  wake_event wake_;
  std::atomic<bool> closing_{false};
  std::optional<std::string> known_; // What was told last.
  server_seeker seeker_;
  std::thread thread_; // Last: it uses all the others.
};

server_inquiry::server_inquiry(std::unique_ptr<impl> x) : impl_(std::move(x)) {}

edge_result<std::unique_ptr<server_inquiry>>
server_inquiry::open(const server_inquiry_options& options,
                     on_server_found callback) {
  if (auto error = check(options))
    return *std::move(error);
  auto address = local_address(options);
  if (auto* error = std::get_if<edge_error>(&address))
    return *error;
  auto resolved = options;
  resolved.address = std::get<std::string>(address);
  try {
    return std::unique_ptr<server_inquiry>{new server_inquiry(
        std::make_unique<impl>(resolved, std::move(callback)))};
  } catch (const std::system_error& why) {
    return edge_error{error_code::conflict,
                      "the discovery server is not looked for: no thread can "
                      "be had: "
                          + why.code().message(),
                      "raise the limit of processes: ulimit -u"};
  }
}

server_inquiry::~server_inquiry() = default;

void server_inquiry::close() {
  impl_->close();
}

} // namespace roscell
