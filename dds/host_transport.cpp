#include "dds/host_transport.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <random>
#include <utility>

namespace roscell {

std::int32_t make_participant_id() {
  constexpr std::int32_t lowest = 1000;
  constexpr std::int32_t highest = 25000;
  std::random_device source;
  return std::uniform_int_distribution<std::int32_t>{lowest, highest}(source);
}

eprosima::fastrtps::rtps::Locator_t udp_locator(const std::string& address,
                                                std::uint32_t port) {
  eprosima::fastrtps::rtps::Locator_t result;
  eprosima::fastrtps::rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4,
                                                     address, port, result);
  return result;
}

namespace {

namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::rtps::IPLocator;
using namespace eprosima::fastdds::rtps;

constexpr const char* loopback = "127.0.0.1";

std::shared_ptr<UDPv4TransportDescriptor>
udp_on(const std::string& address, const host_transport_options& options) {
  auto result = std::make_shared<UDPv4TransportDescriptor>();
  result->interfaceWhiteList = {address};
  result->maxMessageSize = options.max_message_bytes;
  result->sendBufferSize = options.socket_buffer_bytes;
  result->receiveBufferSize = options.socket_buffer_bytes;
  return result;
}

rtps::Locator_t with_address(rtps::Locator_t at, const std::string& address) {
  IPLocator::setIPv4(at, address);
  return at;
}

struct host_descriptor : ChainingTransportDescriptor {
  explicit host_descriptor(const host_transport_options& options)
      : ChainingTransportDescriptor(udp_on(options.address, options)),
        beside(udp_on(loopback, options)), address(options.address) {}

  TransportInterface* create_transport() const override;

  std::shared_ptr<TransportDescriptorInterface> beside;
  std::string address;
};

class host_udp : public ChainingTransport {
public:
  explicit host_udp(const host_descriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor),
        self_(with_address(rtps::Locator_t{}, descriptor.address)),
        is_loopback_(IPLocator::isLocal(self_)),
        beside_(descriptor.beside->create_transport()) {}

  TransportDescriptorInterface* get_configuration() override {
    return &descriptor_;
  }

  bool init(const rtps::PropertyPolicy* properties) override {
    return ChainingTransport::init(properties) && beside_->init(properties);
  }

  bool OpenInputChannel(const rtps::Locator_t& at,
                        TransportReceiverInterface* receiver,
                        std::uint32_t max_bytes) override {
    // Past ChainingTransport, which takes a port that it could not open for
    // an open one when it is asked again.
    if (!low_level_transport_->OpenInputChannel(at, receiver, max_bytes))
      return false;
    if (!needs_second_ear(at)
        || beside_->OpenInputChannel(with_address(at, loopback), receiver,
                                     max_bytes))
      return true;
    // The port is taken there: a participant has both or tries the next.
    ChainingTransport::CloseInputChannel(at);
    return false;
  }

  bool CloseInputChannel(const rtps::Locator_t& at) override {
    if (needs_second_ear(at))
      beside_->CloseInputChannel(with_address(at, loopback));
    return ChainingTransport::CloseInputChannel(at);
  }

  bool transform_remote_locator(const rtps::Locator_t& remote,
                                rtps::Locator_t& result) const override {
    if (!IsLocatorSupported(remote))
      return false;
    result = remote;
    if (!is_local_locator(remote) || IPLocator::compareAddress(remote, self_))
      return true;
    if (!is_loopback_ && !IPLocator::isLocal(remote))
      return false;
    IPLocator::setIPv4(result, loopback);
    return true;
  }

  bool send(rtps::SenderResource* lower, const rtps::octet* data,
            std::uint32_t size, rtps::LocatorsIterator* first,
            rtps::LocatorsIterator* last,
            const std::chrono::steady_clock::time_point& timeout) override {
    return lower->send(data, size, first, last, timeout);
  }

  void receive(TransportReceiverInterface* next, const rtps::octet* data,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    next->OnDataReceived(data, size, local, remote);
  }

private:
  bool needs_second_ear(const rtps::Locator_t& at) const {
    return !is_loopback_ && !IPLocator::isMulticast(at);
  }

  host_descriptor descriptor_;
  const rtps::Locator_t self_;
  const bool is_loopback_;
  const std::unique_ptr<TransportInterface> beside_;
};

TransportInterface* host_descriptor::create_transport() const {
  return new host_udp(*this);
}

} // namespace

std::shared_ptr<TransportDescriptorInterface>
host_transport(const host_transport_options& options) {
  return std::make_shared<host_descriptor>(options);
}

} // namespace roscell
