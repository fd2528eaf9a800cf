#include "skills/ros2/topic_listener.hpp"

#include "skills/ros2/participant.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include <utility>

namespace roscell::ros2 {

class topic_listener::impl : private dds::DataReaderListener {
public:
  impl(const participant_config& config, const std::string& topic,
       const std::string& type, const topic_qos& qos, callback on_message)
      : on_message_(std::move(on_message)), participant_(config),
        reader_(participant_.add_reader(topic, type, qos, this)) {}

  ~impl() override {
    participant_.remove(reader_);
  }

private:
  void on_data_available(dds::DataReader* reader) override {
    using namespace std::chrono;
    using eprosima::fastrtps::types::ReturnCode_t;
    heard_message x;
    dds::SampleInfo info;
    while (reader->take_next_sample(&x.payload, &info)
           == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data)
        continue;
      x.sent = system_clock::time_point{duration_cast<system_clock::duration>(
          nanoseconds{info.source_timestamp.to_ns()})};
      on_message_(std::exchange(x, {}));
    }
  }

  const callback on_message_;
  participant participant_;
  dds::DataReader* const reader_;
};

topic_listener::topic_listener(const participant_config& config,
                               const std::string& topic,
                               const std::string& type, const topic_qos& qos,
                               callback on_message)
    : impl_(std::make_unique<impl>(config, topic, type, qos,
                                   std::move(on_message))) {}

topic_listener::~topic_listener() = default;

} // namespace roscell::ros2
