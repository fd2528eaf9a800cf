#include "skills/ros2/topic_output.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/ros2/participant_qos.hpp"

#include <utility>

namespace roscell::ros2 {

namespace {

using eprosima::fastrtps::types::ReturnCode_t;

const eprosima::fastrtps::Duration_t close_limit{2, 0};

} // namespace

topic_output::topic_output(const engine::stream_context& output,
                           std::shared_ptr<shared_participant> shared)
    : context_(output),
      qos_(writer_qos(output.config.endpoint, output.config.data_type,
                      output.options)),
      shared_(std::move(shared)) {
  // nop
}

topic_output::~topic_output() {
  topic_output::suspend();
}

void topic_output::open() {
  participant_ = shared_->get(context_.options);
  writer_ = participant_->add_writer(context_.config.endpoint,
                                     context_.config.data_type, qos_, this);
}

void topic_output::suspend() {
  if (writer_ != nullptr) {
    participant_->remove(std::exchange(writer_, nullptr));
    participant_->pacer().forget(this);
  }
  participant_.reset();
  const std::lock_guard guard{mutex_};
  best_effort_readers_.clear();
  pace_.set_best_effort_readers(0);
}

void topic_output::resume(const engine::changed_variables& reported) {
  shared_->use(reported);
  open();
  for (const auto& payload : kept_)
    send(payload, "what was kept");
}

void topic_output::write(const engine::frame& result) {
  const auto& type = context_.config.data_type;
  if (result.data_type != type)
    throw engine::stream_error(
        "a '" + result.data_type + "' cannot be written to the topic '"
        + context_.config.endpoint + "' of type '" + type + "'");
  if (qos_.large) {
    const std::lock_guard guard{mutex_};
    participant_->pacer().set_gap(
        this, pace_.next_gap(writer_pace::clock::now(), result.payload.size()));
  }
  send(result.payload, result.name);
  keep(result.payload);
}

void topic_output::keep(const std::string& payload) {
  if (!qos_.transient_local)
    return;
  kept_.push_back(payload);
  if (kept_.size() > static_cast<std::size_t>(qos_.depth))
    kept_.pop_front();
}

void topic_output::send(const std::string& payload, const std::string& name) {
  const auto& topic = context_.config.endpoint;
  // Fast DDS reads the message only, but takes no constant.
  auto* data = const_cast<std::string*>(&payload);
  auto outcome =
      writer_->write(data, eprosima::fastrtps::rtps::c_InstanceHandle_Unknown);
  if (outcome == ReturnCode_t::RETCODE_TIMEOUT)
    context_.say("output '" + topic + "': '" + name
                 + "' was not sent, because the network is too slow");
  else if (outcome != ReturnCode_t::RETCODE_OK)
    throw engine::stream_error("Fast DDS refuses '" + name + "' for the topic '"
                               + topic
                               + "'; is its payload a serialized message?");
}

void topic_output::close() {
  if (writer_ == nullptr)
    return;
  if (writer_->wait_for_acknowledgments(close_limit)
      != ReturnCode_t::RETCODE_OK)
    context_.say("output '" + context_.config.endpoint
                 + "': a reader did not confirm the last messages");
}

void topic_output::on_publication_matched(
    dds::DataWriter*, const dds::PublicationMatchedStatus& status) {
  eprosima::fastrtps::rtps::GUID_t reader;
  eprosima::fastrtps::rtps::iHandle2GUID(reader,
                                         status.last_subscription_handle);
  const auto which = to_guid(reader);
  const bool is_best_effort_reader =
      status.current_count_change > 0
      && participant_->is_best_effort_reader(which);
  {
    const std::lock_guard guard{mutex_};
    if (is_best_effort_reader)
      best_effort_readers_.insert(which);
    else
      best_effort_readers_.erase(which);
    pace_.set_best_effort_readers(
        static_cast<int>(best_effort_readers_.size()));
  }
  context_.say(matched_text(context_.config.endpoint, "reader",
                            status.current_count, status.current_count_change));
}

void topic_output::on_offered_incompatible_qos(
    dds::DataWriter*, const dds::OfferedIncompatibleQosStatus& status) {
  context_.say(incompatible_text(context_.config.endpoint, "reader",
                                 status.last_policy_id));
}

} // namespace roscell::ros2
