#pragma once

#include "roscell/skill/handlers.hpp"
#include "skills/ros2/participant.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace roscell::ros2 {

/// Counts the messages that a reader never saw, by the numbers that every DDS
/// writer gives its messages.
class gap_counter {
public:
  /// Message `number` of `writer` was read. Returns how many of the same writer
  /// are missing before it; none before the first.
  std::uint64_t add(const guid& writer, std::uint64_t number);

  /// The highest number of that writer's messages that were read; 0: none was.
  std::uint64_t last(const guid& writer) const;

private:
  std::map<guid, std::uint64_t> last_;
};

/// Reads a topic. Each message is one frame, pushed by the thread of Fast DDS
/// that received it; when the executor is behind, the oldest frame is dropped.
/// Its time is the header's stamp, or else when it was sent; its name is the
/// topic and the writer's number of it, e.g. "scene_1_image-12".
class topic_input : public engine::input_handler,
                    private dds::DataReaderListener {
public:
  topic_input(const engine::stream_context& input,
              std::shared_ptr<shared_participant> shared);

  ~topic_input() override;

  void open() override;
  void run(engine::frame_sink& sink, const engine::stop_event& stop) override;

  bool survives_new_address() const override {
    return true;
  }

  void suspend() override;

  /// What was missed meanwhile is counted; what a writer has kept for those who
  /// come late is not delivered a second time.
  void resume(const engine::changed_variables& reported) override;

private:
  void on_data_available(dds::DataReader* reader) override;
  void on_subscription_matched(
      dds::DataReader* reader,
      const dds::SubscriptionMatchedStatus& status) override;
  void on_requested_incompatible_qos(
      dds::DataReader* reader,
      const dds::RequestedIncompatibleQosStatus& status) override;

  engine::frame make_frame(std::string payload, const dds::SampleInfo& info);
  void deliver(engine::frame input, const dds::SampleInfo& info);
  bool is_repeated(const guid& writer, std::uint64_t number) const;
  void count_lost(std::uint64_t more);

  const engine::stream_context context_;
  const topic_qos qos_;
  const bool has_header_;
  const std::shared_ptr<shared_participant> shared_;
  std::shared_ptr<participant> participant_;
  dds::DataReader* reader_ = nullptr;
  // Guards what follows. Fast DDS may hold its reader's lock around a call of
  // the listener, so nobody calls the reader while holding this one.
  std::mutex mutex_;
  engine::frame_sink* sink_ = nullptr;
  std::deque<engine::frame> early_; // What came before there was a sink.
  gap_counter gaps_;
  bool moved_ = false;
  std::uint64_t lost_ = 0;
};

} // namespace roscell::ros2
