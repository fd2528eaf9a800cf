#include "actors/edge/dds/rtps/discovery_transport.hpp"

#include "actors/edge/dds/rtps/discovery_filter.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <fastrtps/utils/IPLocator.h>

#include <mutex>
#include <set>
#include <vector>

namespace roscell {

namespace {

namespace rtps = eprosima::fastrtps::rtps;
using namespace eprosima::fastdds::rtps;

struct guarded_descriptor : ChainingTransportDescriptor {
  using ChainingTransportDescriptor::ChainingTransportDescriptor;

  TransportInterface* create_transport() const override;
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
        if (opened_.count(**first) != 0)
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

std::shared_ptr<TransportDescriptorInterface>
guarded_udp_transport(const std::string& address,
                      std::uint32_t max_message_bytes) {
  auto udp = std::make_shared<UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {address};
  udp->maxMessageSize = max_message_bytes;
  return std::make_shared<guarded_descriptor>(udp);
}

} // namespace roscell
