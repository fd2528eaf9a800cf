#include "actors/edge/dds/discovery_transport.hpp"

#include "actors/edge/dds/rtps/discovery_wire.hpp"
#include "dds/host_transport.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <arpa/inet.h>
#include <sys/socket.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace roscell {

namespace {

constexpr const char* own_host = "127.0.0.1";

void set_option(int fd, int level, int name, int value) {
  setsockopt(fd, level, name, &value, sizeof(value));
}

/// A socket that gets what is sent to a group over the interface of `address`.
std::optional<udp_socket> join(const std::string& group, std::uint16_t port,
                               const std::string& address) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  ip_mreq membership{};
  if (inet_pton(AF_INET, group.c_str(), &at.sin_addr) != 1
      || inet_pton(AF_INET, address.c_str(), &membership.imr_interface) != 1)
    return std::nullopt;
  membership.imr_multiaddr = at.sin_addr;
  udp_socket result{
      socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  set_option(result.fd(), SOL_SOCKET, SO_REUSEADDR, 1);
  if (bind(result.fd(), reinterpret_cast<const sockaddr*>(&at), sizeof(at))
      != 0)
    return std::nullopt;
  setsockopt(result.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership,
             sizeof(membership));
  return result;
}

} // namespace

datagram_inlet::datagram_inlet(inlet_options options)
    : options_(std::move(options)), thread_(dds_thread::shared()) {
  // nop
}

bool datagram_inlet::open(std::uint16_t port, on_datagram hear,
                          on_datagram hear_loopback) {
  std::vector<std::unique_ptr<entry>> ears;
  ears.push_back(listen_at(options_.address, port, std::move(hear)));
  if (ears.back() && options_.at_loopback && options_.address != own_host)
    ears.push_back(listen_at(own_host, port, std::move(hear_loopback)));
  if (!ears.back())
    return false;
  const std::lock_guard lock{mutex_};
  ports_[port] = std::move(ears);
  return true;
}

bool datagram_inlet::open_group(const std::string& group, std::uint16_t port,
                                on_datagram hear) {
  auto socket = join(group, port, options_.address);
  if (!socket)
    return false;
  auto ear = listen(*std::move(socket), std::move(hear));
  if (!ear)
    return false;
  const std::lock_guard lock{mutex_};
  ports_[port].push_back(std::move(ear));
  return true;
}

bool datagram_inlet::is_open(std::uint16_t port) const {
  const std::lock_guard lock{mutex_};
  return ports_.count(port) != 0;
}

bool datagram_inlet::close(std::uint16_t port) {
  // They end unlocked: each waits until it is not called any more.
  std::vector<std::unique_ptr<entry>> ears;
  const std::lock_guard lock{mutex_};
  const auto found = ports_.find(port);
  if (found == ports_.end())
    return false;
  ears = std::move(found->second);
  ports_.erase(found);
  return true;
}

std::unique_ptr<dds_thread::entry> datagram_inlet::listen(udp_socket socket,
                                                          on_datagram hear) {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (const auto wanted = std::min(options_.buffer_bytes, most); wanted != 0)
    set_option(socket.fd(), SOL_SOCKET, SO_RCVBUF, static_cast<int>(wanted));
  return thread_->listen(std::move(socket), options_.max_bytes,
                         std::move(hear));
}

std::unique_ptr<dds_thread::entry>
datagram_inlet::listen_at(const std::string& address, std::uint16_t port,
                          on_datagram hear) {
  auto bound = udp_socket::bind(address, port);
  if (auto* socket = std::get_if<udp_socket>(&bound))
    return listen(std::move(*socket), std::move(hear));
  return nullptr;
}

namespace {

namespace rtps = eprosima::fastrtps::rtps;
using namespace eprosima::fastdds::rtps;

std::shared_ptr<TransportDescriptorInterface>
sending_transport(const discovery_transport_options& options) {
  if (options.serves_programs)
    return host_transport(
        {options.address, options.max_sent_bytes, options.socket_buffer_bytes});
  auto result = std::make_shared<UDPv4TransportDescriptor>();
  result->interfaceWhiteList = {options.address};
  result->maxMessageSize = options.max_sent_bytes;
  return result;
}

struct guarded_descriptor : ChainingTransportDescriptor {
  explicit guarded_descriptor(discovery_transport_options x)
      : ChainingTransportDescriptor(sending_transport(x)),
        options(std::move(x)) {}

  TransportInterface* create_transport() const override;

  discovery_transport_options options;
};

rtps::Locator_t locator_of(const sockaddr_in& x) {
  rtps::Locator_t result;
  result.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setPhysicalPort(result, ntohs(x.sin_port));
  rtps::IPLocator::setIPv4(result,
                           reinterpret_cast<const rtps::octet*>(&x.sin_addr));
  return result;
}

rtps::Locator_t with_address(rtps::Locator_t at, const std::string& address) {
  rtps::IPLocator::setIPv4(at, address);
  return at;
}

class guarded_transport : public ChainingTransport {
public:
  explicit guarded_transport(const guarded_descriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor),
        inlet_({options().address, options().serves_programs,
                options().max_heard_bytes, options().socket_buffer_bytes}) {}

  TransportDescriptorInterface* get_configuration() override {
    return &descriptor_;
  }

  bool IsInputChannelOpen(const rtps::Locator_t& at) const override {
    return IsLocatorSupported(at) && inlet_.is_open(port_of(at));
  }

  bool OpenInputChannel(const rtps::Locator_t& at,
                        TransportReceiverInterface* receiver,
                        std::uint32_t) override {
    // Fast DDS does not send from an interface without a carrier; who heard
    // there could not answer.
    if (!is_locator_allowed(with_address(at, options().address)))
      return false;
    if (rtps::IPLocator::isMulticast(at))
      return inlet_.open_group(rtps::IPLocator::toIPv4string(at), port_of(at),
                               to(receiver, at));
    if (!is_locator_allowed(at)
        || !inlet_.open(port_of(at), to(receiver, at),
                        to(receiver, with_address(at, "127.0.0.1"))))
      return false;
    if (options().guard)
      options().guard->set_inlet(
          [at, receiver](const std::vector<std::uint8_t>& message) {
            receiver->OnDataReceived(
                message.data(), static_cast<uint32_t>(message.size()), at, at);
          });
    return true;
  }

  bool CloseInputChannel(const rtps::Locator_t& at) override {
    if (options().guard)
      options().guard->set_inlet({});
    return inlet_.close(port_of(at));
  }

  bool OpenOutputChannel(SendResourceList& senders,
                         const rtps::Locator_t& to) override {
    if (!ChainingTransport::OpenOutputChannel(senders, to))
      return false;
    std::lock_guard<std::mutex> lock{mutex_};
    opened_.insert(to);
    return true;
  }

  /// Fast DDS asserts that it opened a channel to wherever it sends. Its
  /// discovery server does not keep to that: it announces itself to clients
  /// that it is about to match, and to those it could not match.
  bool send(rtps::SenderResource* lower, const rtps::octet* data, uint32_t size,
            rtps::LocatorsIterator* first, rtps::LocatorsIterator* last,
            const std::chrono::steady_clock::time_point& timeout) override {
    std::vector<rtps::Locator_t> opened;
    {
      std::lock_guard<std::mutex> lock{mutex_};
      for (; *first != *last; ++*first)
        if (opened_.count(**first) != 0)
          opened.push_back(**first);
    }
    Locators begin{opened.cbegin()};
    Locators end{opened.cend()};
    if (!options().guard)
      return lower->send(data, size, &begin, &end, timeout);
    // Fast DDS may send the same bytes again.
    std::vector<rtps::octet> message(data, data + size);
    return !options().guard->let_out(message.data(), message.size())
           || lower->send(message.data(), size, &begin, &end, timeout);
  }

  void receive(TransportReceiverInterface* next, const rtps::octet* data,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    next->OnDataReceived(data, size, local, remote);
  }

private:
  static std::uint16_t port_of(const rtps::Locator_t& at) {
    return rtps::IPLocator::getPhysicalPort(at);
  }

  const discovery_transport_options& options() const {
    return descriptor_.options;
  }

  /// Gives `next` what comes to `local`.
  dds_thread::on_datagram to(TransportReceiverInterface* next,
                             const rtps::Locator_t& local) {
    return [this, next, local](std::uint8_t* message, std::size_t size,
                               const sockaddr_in& from) {
      hear(*next, local, message, size, from);
    };
  }

  void hear(TransportReceiverInterface& next, const rtps::Locator_t& local,
            std::uint8_t* message, std::size_t size, const sockaddr_in& from) {
    const auto how = rtps::IPLocator::isMulticast(local) ? arrival::multicast
                                                         : arrival::direct;
    if (!make_safe(message, size, how))
      return;
    const auto remote = locator_of(from);
    const auto& guard = options().guard;
    if (guard && !guard->take_in(message, size, from))
      return;
    next.OnDataReceived(message, static_cast<std::uint32_t>(size), local,
                        remote);
    if (!guard)
      return;
    const auto sequel = guard->sequel_of(message, size);
    if (!sequel.empty())
      next.OnDataReceived(sequel.data(),
                          static_cast<std::uint32_t>(sequel.size()), local,
                          remote);
  }

  guarded_descriptor descriptor_;
  std::mutex mutex_;
  std::set<rtps::Locator_t> opened_;
  datagram_inlet inlet_; // Last: it calls this.
};

TransportInterface* guarded_descriptor::create_transport() const {
  return new guarded_transport(*this);
}

} // namespace

std::shared_ptr<TransportDescriptorInterface>
discovery_transport(discovery_transport_options options) {
  return std::make_shared<guarded_descriptor>(std::move(options));
}

} // namespace roscell
