#include "skills/ros2/topic_input.hpp"

#include "roscell/ros2/stamp.hpp"
#include "skills/ros2/participant_config.hpp"
#include "skills/ros2/participant_qos.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include <algorithm>
#include <utility>

namespace roscell::ros2 {

namespace {

using clock = std::chrono::system_clock;
using eprosima::fastrtps::types::ReturnCode_t;

} // namespace

topic_input::topic_input(const engine::stream_context& input,
                         std::shared_ptr<shared_participant> shared)
    : context_(input), qos_(reader_qos(input.config.endpoint,
                                       input.config.data_type, input.options)),
      has_header_(begins_with_header(input.config.data_type)),
      shared_(std::move(shared)) {
  // nop
}

topic_input::~topic_input() {
  topic_input::suspend();
}

void topic_input::open() {
  participant_ = shared_->get(context_.options);
  reader_ = participant_->add_reader(context_.config.endpoint,
                                     context_.config.data_type, qos_, this);
}

void topic_input::run(engine::frame_sink& sink,
                      const engine::stop_event& stop) {
  {
    std::lock_guard guard{mutex_};
    for (auto& input : early_)
      sink.push(std::move(input), engine::when_full::drop_oldest);
    early_.clear();
    sink_ = &sink;
  }
  stop.wait();
  std::lock_guard guard{mutex_};
  sink_ = nullptr;
}

/// The listener's call that is under way takes the lock, so nobody holds it.
void topic_input::suspend() {
  if (reader_ != nullptr)
    participant_->remove(std::exchange(reader_, nullptr));
  participant_.reset();
}

void topic_input::resume(const engine::changed_variables& reported) {
  {
    const std::lock_guard guard{mutex_};
    moved_ = true;
  }
  shared_->use(reported);
  open();
}

void topic_input::on_data_available(dds::DataReader* reader) {
  std::string payload;
  dds::SampleInfo info;
  while (reader->take_next_sample(&payload, &info) == ReturnCode_t::RETCODE_OK)
    if (info.valid_data)
      deliver(make_frame(std::exchange(payload, {}), info), info);
}

void topic_input::on_subscription_matched(
    dds::DataReader*, const dds::SubscriptionMatchedStatus& status) {
  context_.say(matched_text(context_.config.endpoint, "writer",
                            status.current_count, status.current_count_change));
}

void topic_input::on_requested_incompatible_qos(
    dds::DataReader*, const dds::RequestedIncompatibleQosStatus& status) {
  context_.say(incompatible_text(context_.config.endpoint, "writer",
                                 status.last_policy_id));
}

engine::frame topic_input::make_frame(std::string payload,
                                      const dds::SampleInfo& info) {
  engine::frame result;
  result.time = clock::time_point{std::chrono::duration_cast<clock::duration>(
      std::chrono::nanoseconds{info.source_timestamp.to_ns()})};
  if (has_header_)
    if (auto stamp = stamp_of(payload))
      result.time = to_time_point(*stamp);
  result.payload = std::move(payload);
  result.name =
      context_.config.endpoint.substr(1) + '-'
      + std::to_string(info.sample_identity.sequence_number().to64long());
  std::replace(result.name.begin(), result.name.end(), '/', '_');
  return result;
}

void topic_input::deliver(engine::frame input, const dds::SampleInfo& info) {
  const auto writer = to_guid(info.sample_identity.writer_guid());
  const auto number = static_cast<std::uint64_t>(
      info.sample_identity.sequence_number().to64long());
  std::lock_guard guard{mutex_};
  if (is_repeated(writer, number))
    return;
  count_lost(gaps_.add(writer, number));
  if (sink_ != nullptr) {
    sink_->push(std::move(input), engine::when_full::drop_oldest);
    return;
  }
  early_.push_back(std::move(input));
  if (early_.size() > static_cast<std::size_t>(qos_.depth))
    early_.pop_front();
}

/// Only a reader of what is kept gets it again, and only another reader.
bool topic_input::is_repeated(const guid& writer, std::uint64_t number) const {
  return moved_ && qos_.transient_local && number <= gaps_.last(writer);
}

/// Says it less and less often, so that a bad network does not fill the log.
void topic_input::count_lost(std::uint64_t more) {
  auto before = lost_;
  lost_ += more;
  // True when the number has got another binary digit.
  if ((before ^ lost_) > before)
    context_.say("input '" + context_.config.endpoint + "' has lost "
                 + std::to_string(lost_)
                 + " messages on the way; see skills/README.md, large images");
}

namespace {

/// Writers come and go for as long as a skill runs.
constexpr std::size_t max_writers = 1024;

} // namespace

std::uint64_t gap_counter::add(const guid& writer, std::uint64_t number) {
  auto known = last_.find(writer);
  if (known == last_.end()) {
    if (last_.size() >= max_writers)
      last_.clear();
    last_.emplace(writer, number);
    return 0;
  }
  auto last = std::exchange(known->second, std::max(known->second, number));
  return number > last ? number - last - 1 : 0;
}

std::uint64_t gap_counter::last(const guid& writer) const {
  const auto known = last_.find(writer);
  return known == last_.end() ? 0 : known->second;
}

} // namespace roscell::ros2
