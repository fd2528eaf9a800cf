#include "actors/edge/dds/rtps/discovery_transport.hpp"

#include "actors/edge/dds/rtps/discovery_filter.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <fastrtps/utils/IPLocator.h>

#include <cstring>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include <arpa/inet.h>

namespace roscell {

namespace {

namespace rtps = eprosima::fastrtps::rtps;
using namespace eprosima::fastdds::rtps;

struct guarded_descriptor : ChainingTransportDescriptor {
  guarded_descriptor(std::shared_ptr<TransportDescriptorInterface> lower,
                     std::shared_ptr<discovery_guard> whose)
      : ChainingTransportDescriptor(std::move(lower)), guard(std::move(whose)) {
  }

  TransportInterface* create_transport() const override;

  std::shared_ptr<discovery_guard> guard;
};

sockaddr_in address_of(const rtps::Locator_t& x) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(rtps::IPLocator::getPhysicalPort(x));
  std::memcpy(&result.sin_addr, rtps::IPLocator::getIPv4(x),
              sizeof(result.sin_addr));
  return result;
}

class guarded_transport : public ChainingTransport {
public:
  explicit guarded_transport(const guarded_descriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}

  TransportDescriptorInterface* get_configuration() override {
    return &descriptor_;
  }

  bool OpenInputChannel(const rtps::Locator_t& at,
                        TransportReceiverInterface* receiver,
                        std::uint32_t max_bytes) override {
    if (!ChainingTransport::OpenInputChannel(at, receiver, max_bytes))
      return false;
    // The channel of the messages' port, which is the same one, is asked for
    // after that of discovery.
    if (descriptor_.guard && !std::exchange(has_inlet_, true))
      descriptor_.guard->set_inlet(
          [at, receiver](const std::vector<std::uint8_t>& message) {
            receiver->OnDataReceived(
                message.data(), static_cast<uint32_t>(message.size()), at, at);
          });
    return true;
  }

  bool CloseInputChannel(const rtps::Locator_t& at) override {
    if (descriptor_.guard)
      descriptor_.guard->set_inlet({});
    return ChainingTransport::CloseInputChannel(at);
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
    if (!descriptor_.guard)
      return lower->send(data, size, &begin, &end, timeout);
    // Fast DDS may send the same bytes again.
    std::vector<rtps::octet> message(data, data + size);
    return !descriptor_.guard->let_out(message.data(), message.size())
           || lower->send(message.data(), size, &begin, &end, timeout);
  }

  void receive(TransportReceiverInterface* next, const rtps::octet* data,
               uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    // The data are in the receiving thread's own buffer.
    auto how = rtps::IPLocator::isMulticast(local) ? arrival::multicast
                                                   : arrival::direct;
    auto* const message = const_cast<rtps::octet*>(data);
    if (!make_safe(message, size, how))
      return;
    const auto& guard = descriptor_.guard;
    if (!guard)
      return next->OnDataReceived(data, size, local, remote);
    if (!guard->take_in(message, size, address_of(remote)))
      return;
    next->OnDataReceived(data, size, local, remote);
    const auto sequel = guard->sequel_of(message, size);
    if (!sequel.empty())
      next->OnDataReceived(sequel.data(),
                           static_cast<std::uint32_t>(sequel.size()), local,
                           remote);
  }

private:
  guarded_descriptor descriptor_;
  bool has_inlet_ = false;
  std::mutex mutex_;
  std::set<rtps::Locator_t> opened_;
};

TransportInterface* guarded_descriptor::create_transport() const {
  return new guarded_transport(*this);
}

} // namespace

std::shared_ptr<TransportDescriptorInterface>
udp_transport(const host_transport_options& options) {
  auto result = std::make_shared<UDPv4TransportDescriptor>();
  result->interfaceWhiteList = {options.address};
  result->maxMessageSize = options.max_message_bytes;
  return result;
}

std::shared_ptr<TransportDescriptorInterface>
guarded(std::shared_ptr<TransportDescriptorInterface> lower,
        std::shared_ptr<discovery_guard> guard) {
  return std::make_shared<guarded_descriptor>(std::move(lower),
                                              std::move(guard));
}

} // namespace roscell
