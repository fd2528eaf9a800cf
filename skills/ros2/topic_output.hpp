#pragma once

#include "roscell/skill/handlers.hpp"
#include "skills/ros2/participant.hpp"

#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>

namespace roscell::ros2 {

/// Writes a topic. The payload of a frame must be a message of the output's
/// type, and is copied once, into the history of the DDS writer.
class topic_output : public engine::output_handler,
                     private dds::DataWriterListener {
public:
  topic_output(const engine::stream_context& output,
               std::shared_ptr<shared_participant> shared);

  ~topic_output() override;

  void open() override;
  void write(const engine::frame& result) override;

  /// Waits at most 2 s for readers that lost something.
  void close() override;

  bool survives_new_address() const override {
    return true;
  }

  void suspend() override;

  /// What is kept for readers that come late is written again.
  void resume(const engine::changed_variables& reported) override;

private:
  void send(const std::string& payload, const std::string& name);
  void keep(const std::string& payload);
  void
  on_publication_matched(dds::DataWriter* writer,
                         const dds::PublicationMatchedStatus& status) override;
  void on_offered_incompatible_qos(
      dds::DataWriter* writer,
      const dds::OfferedIncompatibleQosStatus& status) override;

  const engine::stream_context context_;
  const topic_qos qos_;
  const std::shared_ptr<shared_participant> shared_;
  std::shared_ptr<participant> participant_;
  dds::DataWriter* writer_ = nullptr;
  std::deque<std::string> kept_; // As the writer keeps them, for another one.
  std::mutex mutex_;             // Guards what follows.
  std::set<guid> best_effort_readers_;
  writer_pace pace_;
};

} // namespace roscell::ros2
