#include "skills/ros2/flow/pace.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <utility>

namespace roscell::ros2 {

namespace {

using namespace std::chrono_literals;

/// What fits into a datagram of Fast DDS, nearly.
constexpr std::size_t datagram_bytes = 65000;

/// A socket of 208 KiB holds three datagrams, and a stock reader is rarely held
/// up for longer than they then take.
constexpr std::chrono::microseconds longest_gap{2000};

/// Smaller ones are no parts of images.
constexpr std::size_t least_paced_bytes = 32768;

} // namespace

writer_pace::clock::duration writer_pace::next_gap(clock::time_point now,
                                                   std::size_t bytes) {
  // A pause says nothing of the pace before and after it.
  constexpr clock::duration longest_interval = 1s;
  if (last_ != clock::time_point{} && now - last_ < longest_interval) {
    const auto since = now - last_;
    interval_ =
        interval_ == clock::duration{} ? since : (3 * interval_ + since) / 4;
  }
  last_ = now;
  const auto parts = static_cast<int>(bytes / datagram_bytes) + 1;
  if (best_effort_readers_ == 0 || parts < 3)
    return {};
  if (interval_ == clock::duration{})
    return longest_gap;
  return std::min<clock::duration>(longest_gap, interval_ / 2 / parts);
}

void datagram_pacer::set_gap(const void* writer,
                             writer_pace::clock::duration gap) {
  const std::lock_guard guard{mutex_};
  gaps_[writer] = gap;
  choose();
}

void datagram_pacer::forget(const void* writer) {
  const std::lock_guard guard{mutex_};
  gaps_.erase(writer);
  choose();
}

void datagram_pacer::choose() {
  writer_pace::clock::duration shortest{};
  for (const auto& [writer, gap] : gaps_)
    if (gap > gap.zero() && (shortest == shortest.zero() || gap < shortest))
      shortest = gap;
  gap_ = shortest;
}

void datagram_pacer::wait_turn(std::size_t bytes) {
  const auto gap = gap_.load();
  if (gap == gap.zero() || bytes < least_paced_bytes)
    return;
  const auto now = writer_pace::clock::now();
  if (due_ > now)
    never_.wait_until(due_);
  due_ = std::max(due_, now) + gap;
}

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
