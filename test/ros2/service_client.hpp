#pragma once

#include "roscell/skill/environment.hpp"
#include "skills/ros2/participant.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/rtps/common/WriteParams.h>

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>

namespace roscell::test {

/// A client as rmw_fastrtps makes one: the request names the reader.
class service_client : private ros2::dds::DataReaderListener,
                       private ros2::dds::DataWriterListener {
public:
  /// @param type "GetParameters" of the service "get_parameters".
  service_client(const engine::variable_lookup& place, const std::string& node,
                 const std::string& service, const std::string& type)
      : shared_(place), participant_(shared_.get(engine::parameters{})) {
    const auto dds_type = "rcl_interfaces::srv::dds_::" + type;
    replies_ =
        participant_->add_named_reader("rr/" + node + "/" + service + "Reply",
                                       dds_type + "_Response_", {}, this);
    requests_ =
        participant_->add_named_writer("rq/" + node + "/" + service + "Request",
                                       dds_type + "_Request_", {}, this);
  }

  ~service_client() override {
    participant_->remove(requests_);
    participant_->remove(replies_);
  }

  service_client(const service_client&) = delete;
  service_client& operator=(const service_client&) = delete;

  /// The reply that names the request; empty: none has come.
  std::string call(std::string request,
                   std::chrono::milliseconds limit = std::chrono::seconds{30}) {
    std::unique_lock guard{mutex_};
    if (!changed_.wait_for(guard, std::chrono::seconds{30},
                           [this] { return writers_ > 0 && readers_ > 0; }))
      return {};
    eprosima::fastrtps::rtps::WriteParams sent;
    sent.related_sample_identity().writer_guid(replies_->guid());
    guard.unlock();
    requests_->write(&request, sent);
    guard.lock();
    const auto number = sent.sample_identity().sequence_number();
    if (!changed_.wait_for(guard, limit, [&] {
          return answer_to_ == number && !answer_.empty();
        }))
      return {};
    return answer_;
  }

private:
  void on_data_available(ros2::dds::DataReader* reader) override {
    std::string payload;
    ros2::dds::SampleInfo info;
    const std::lock_guard guard{mutex_};
    while (reader->take_next_sample(&payload, &info)
           == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      const auto& to = info.related_sample_identity;
      if (!info.valid_data || to.writer_guid() != replies_->guid())
        continue;
      answer_ = payload;
      answer_to_ = to.sequence_number();
    }
    changed_.notify_all();
  }

  void on_subscription_matched(
      ros2::dds::DataReader*,
      const ros2::dds::SubscriptionMatchedStatus& status) override {
    const std::lock_guard guard{mutex_};
    writers_ = status.current_count;
    changed_.notify_all();
  }

  void on_publication_matched(
      ros2::dds::DataWriter*,
      const ros2::dds::PublicationMatchedStatus& status) override {
    const std::lock_guard guard{mutex_};
    readers_ = status.current_count;
    changed_.notify_all();
  }

  ros2::shared_participant shared_;
  std::shared_ptr<ros2::participant> participant_;
  ros2::dds::DataReader* replies_ = nullptr;
  ros2::dds::DataWriter* requests_ = nullptr;
  std::mutex mutex_;
  std::condition_variable changed_;
  int writers_ = 0;
  int readers_ = 0;
  std::string answer_;
  eprosima::fastrtps::rtps::SequenceNumber_t answer_to_;
};

} // namespace roscell::test
