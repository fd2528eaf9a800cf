#include "actors/edge/dds/rtps/discovery_transport.hpp"

#include "actors/edge/dds/rtps/discovery_filter.hpp"
#include "dds/participant_ids.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <fastrtps/utils/IPLocator.h>

#include <mutex>
#include <set>
#include <utility>
#include <vector>

namespace roscell {

namespace {

namespace rtps = eprosima::fastrtps::rtps;
using namespace eprosima::fastdds::rtps;

struct guarded_descriptor : ChainingTransportDescriptor {
  guarded_descriptor(std::shared_ptr<TransportDescriptorInterface> lower,
                     std::shared_ptr<route_gate> shut_route)
      : ChainingTransportDescriptor(std::move(lower)),
        route(std::move(shut_route)) {}

  TransportInterface* create_transport() const override;

  std::shared_ptr<route_gate> route;
};

class guarded_transport : public ChainingTransport {
public:
  explicit guarded_transport(const guarded_descriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}

  TransportDescriptorInterface* get_configuration() override {
    return &descriptor_;
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
        if (opened_.count(**first) != 0
            && (!descriptor_.route || descriptor_.route->passes(**first)))
          opened.push_back(**first);
    }
    Locators begin{opened.cbegin()};
    Locators end{opened.cend()};
    return lower->send(data, size, &begin, &end, timeout);
  }

  void receive(TransportReceiverInterface* next, const rtps::octet* data,
               uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    // The data are in the receiving thread's own buffer.
    auto how = rtps::IPLocator::isMulticast(local) ? arrival::multicast
                                                   : arrival::direct;
    if (make_safe(const_cast<rtps::octet*>(data), size, how))
      next->OnDataReceived(data, size, local, remote);
  }

private:
  guarded_descriptor descriptor_;
  std::mutex mutex_;
  std::set<rtps::Locator_t> opened_;
};

TransportInterface* guarded_descriptor::create_transport() const {
  return new guarded_transport(*this);
}

} // namespace

route_gate::route_gate(const std::string& address, std::uint16_t port)
    : to_(udp_locator(address, port)) {}

std::shared_ptr<TransportDescriptorInterface>
udp_transport(const host_transport_options& options) {
  auto result = std::make_shared<UDPv4TransportDescriptor>();
  result->interfaceWhiteList = {options.address};
  result->maxMessageSize = options.max_message_bytes;
  return result;
}

std::shared_ptr<TransportDescriptorInterface>
guarded(std::shared_ptr<TransportDescriptorInterface> lower,
        std::shared_ptr<route_gate> route) {
  return std::make_shared<guarded_descriptor>(std::move(lower),
                                              std::move(route));
}

} // namespace roscell
