#include "skills/ros2/flow/paced_transport.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

#include <fastrtps/utils/IPLocator.h>

#include <utility>

namespace roscell::ros2 {

namespace {

namespace rtps = eprosima::fastrtps::rtps;
using namespace eprosima::fastdds::rtps;

struct paced_descriptor : ChainingTransportDescriptor {
  paced_descriptor(transport_ptr lower, std::shared_ptr<datagram_pacer> by,
                   port_handler handler)
      : ChainingTransportDescriptor(std::move(lower)), pacer(std::move(by)),
        on_listening(std::move(handler)) {}

  TransportInterface* create_transport() const override;

  std::shared_ptr<datagram_pacer> pacer;
  port_handler on_listening;
};

class paced_transport : public ChainingTransport {
public:
  explicit paced_transport(const paced_descriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}

  TransportDescriptorInterface* get_configuration() override {
    return &descriptor_;
  }

  /// Past ChainingTransport: see host_transport.cpp.
  bool OpenInputChannel(const rtps::Locator_t& at,
                        TransportReceiverInterface* receiver,
                        std::uint32_t max_bytes) override {
    if (!low_level_transport_->OpenInputChannel(at, receiver, max_bytes))
      return false;
    if (descriptor_.on_listening && !rtps::IPLocator::isMulticast(at))
      descriptor_.on_listening(at.port);
    return true;
  }

  bool send(rtps::SenderResource* lower, const rtps::octet* data,
            std::uint32_t size, rtps::LocatorsIterator* first,
            rtps::LocatorsIterator* last,
            const std::chrono::steady_clock::time_point& timeout) override {
    descriptor_.pacer->wait_turn(size);
    return lower->send(data, size, first, last, timeout);
  }

  void receive(TransportReceiverInterface* next, const rtps::octet* data,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    next->OnDataReceived(data, size, local, remote);
  }

private:
  paced_descriptor descriptor_;
};

TransportInterface* paced_descriptor::create_transport() const {
  return new paced_transport(*this);
}

} // namespace

transport_ptr paced(transport_ptr lower, std::shared_ptr<datagram_pacer> pacer,
                    port_handler on_listening) {
  return std::make_shared<paced_descriptor>(std::move(lower), std::move(pacer),
                                            std::move(on_listening));
}

} // namespace roscell::ros2
