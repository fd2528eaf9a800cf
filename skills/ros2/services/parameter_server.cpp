#include "skills/ros2/services/parameter_server.hpp"

#include "roscell/ros2/cdr_error.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/rtps/common/WriteParams.h>

#include <utility>

namespace roscell::ros2 {

namespace {

using eprosima::fastrtps::rtps::GUID_t;
using eprosima::fastrtps::rtps::SampleIdentity;
using eprosima::fastrtps::types::ReturnCode_t;

std::string remedy_of(const engine::environment& env) {
  return "not allowed by DDS, which proves nobody; on a node of the cell: "
         "roscell set "
         + env.instance + " NAME=VALUE";
}

/// The reply goes to the reader that the request names; of a client that names
/// none, to the writer that has sent it.
SampleIdentity origin_of(const dds::SampleInfo& info) {
  auto result = info.sample_identity;
  const auto& reader = info.related_sample_identity.writer_guid();
  if (reader != GUID_t::unknown())
    result.writer_guid(reader);
  return result;
}

bool is_reader(const guid& x) {
  constexpr std::uint8_t reader_bit = 0x04;
  return (x.back() & reader_bit) != 0;
}

} // namespace

struct parameter_server::service : dds::DataReaderListener,
                                   dds::DataWriterListener {
  service(parameter_server& whose, const parameter_service& of)
      : owner(whose), what(of) {
    // nop
  }

  void on_data_available(dds::DataReader* reader) override {
    owner.take(*this, *reader);
  }

  void
  on_publication_matched(dds::DataWriter*,
                         const dds::PublicationMatchedStatus& status) override {
    GUID_t reader;
    eprosima::fastrtps::rtps::iHandle2GUID(reader,
                                           status.last_subscription_handle);
    const std::lock_guard guard{owner.mutex_};
    if (status.current_count_change > 0)
      readers.insert(to_guid(reader));
    else
      readers.erase(to_guid(reader));
    owner.changed_.notify_all();
  }

  parameter_server& owner;
  const parameter_service& what;
  std::set<guid> readers;
  dds::DataReader* requests = nullptr;
  dds::DataWriter* replies = nullptr;
};

parameter_server::parameter_server(const engine::environment& env,
                                   std::shared_ptr<shared_participant> shared,
                                   engine::say_function say,
                                   engine::request_function ask_cell)
    : options_(env.parameters), shared_(std::move(shared)),
      say_(std::move(say)),
      ask_cell_(env.ros2_set_parameters ? std::move(ask_cell) : nullptr),
      answers_(env.changeable, remedy_of(env)) {
  // nop
}

parameter_server::~parameter_server() {
  parameter_server::suspend();
}

void parameter_server::open(const engine::parameters& now) {
  show(now);
  begin();
}

void parameter_server::show(const engine::parameters& now) {
  const std::lock_guard guard{mutex_};
  answers_.set(now.all());
}

void parameter_server::begin() {
  participant_ = shared_->get(options_);
  for (const auto& x : parameter_services()) {
    services_.push_back(std::make_unique<service>(*this, x));
    auto& made = *services_.back();
    const auto name = "/" + participant_->node_name() + "/" + x.name;
    made.replies = participant_->add_named_writer("rr" + name + "Reply",
                                                  x.response, {}, &made);
    made.requests = participant_->add_named_reader("rq" + name + "Request",
                                                   x.request, {}, &made);
  }
  stopping_ = false;
  thread_ = std::thread{[this] { run(); }};
}

/// The listener's call that is under way takes the lock, so nobody holds it.
void parameter_server::suspend() {
  {
    const std::lock_guard guard{mutex_};
    stopping_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable())
    thread_.join();
  for (auto& x : services_) {
    if (x->requests != nullptr)
      participant_->remove(x->requests);
    if (x->replies != nullptr)
      participant_->remove(x->replies);
  }
  waiting_.clear();
  open_.reset();
  services_.clear();
  participant_.reset();
}

void parameter_server::resume(const engine::changed_variables& reported) {
  shared_->use(reported);
  begin();
}

void parameter_server::take(service& of, dds::DataReader& from) {
  std::string payload;
  dds::SampleInfo info;
  const std::lock_guard guard{mutex_};
  while (from.take_next_sample(&payload, &info) == ReturnCode_t::RETCODE_OK)
    if (info.valid_data && payload.size() <= most_request_bytes
        && waiting_.size() < most_waiting)
      waiting_.push_back({&of, origin_of(info), std::exchange(payload, {})});
  changed_.notify_all();
}

void parameter_server::on_answer(std::int64_t request,
                                 const std::string& problem) {
  const std::lock_guard guard{mutex_};
  if (open_ && open_->number == request)
    open_->problem = problem;
  changed_.notify_all();
}

void parameter_server::wait_for_work(lock& guard) {
  const auto is_there = [this] {
    return stopping_ || !waiting_.empty() || (open_ && open_->problem);
  };
  if (open_)
    changed_.wait_until(guard, open_->until, is_there);
  else
    changed_.wait(guard, is_there);
}

void parameter_server::run() {
  lock guard{mutex_};
  for (;;) {
    wait_for_work(guard);
    if (stopping_)
      return;
    if (open_
        && (open_->problem || std::chrono::steady_clock::now() >= open_->until))
      end_request(guard);
    if (waiting_.empty())
      continue;
    const auto next = std::move(waiting_.front());
    waiting_.pop_front();
    answer(guard, next);
  }
}

void parameter_server::answer(lock& guard, const request& x) {
  const auto whom = to_guid(x.from.writer_guid());
  const bool is_known = changed_.wait_for(guard, reader_patience, [&] {
    return stopping_ || !is_reader(whom) || x.of->readers.count(whom) > 0;
  });
  if (stopping_ || !is_known)
    return;
  try {
    if (ask_cell_ && x.of->what.kind != parameter_service::reads)
      begin_request(guard, x);
    else
      reply(guard, x, (answers_.*x.of->what.answer)(x.payload));
  } catch (const cdr_error& e) {
    say_(std::string{"a request to '"} + x.of->what.name
         + "' cannot be read: " + e.what());
  }
}

/// The answer may come at once: it is looked at when the lock is let go.
void parameter_server::begin_request(lock& guard, const request& x) {
  auto wanted = answers_.read_request(
      x.payload, x.of->what.kind == parameter_service::sets_all);
  if (wanted.changes().empty())
    return reply(guard, x, wanted.reply(""));
  if (open_)
    return reply(guard, x, wanted.reply("another change is under way"));
  const auto number = ask_cell_(wanted.changes());
  if (number == 0)
    return reply(guard, x,
                 wanted.reply("it is more than the cell can be asked for at a "
                              "time, or nobody is there to be asked"));
  open_ = open_request{number,
                       std::move(wanted),
                       x,
                       std::chrono::steady_clock::now() + cell_patience,
                       {}};
}

void parameter_server::end_request(lock& guard) {
  const auto ended = std::move(*open_);
  open_.reset();
  reply(
      guard, ended.from,
      ended.wanted.reply(ended.problem.value_or("the cell has not answered")));
}

/// Without the lock: the listeners of DDS take it while DDS holds its own.
void parameter_server::reply(lock& guard, const request& x, std::string text) {
  eprosima::fastrtps::rtps::WriteParams to;
  to.related_sample_identity(x.from);
  guard.unlock();
  x.of->replies->write(&text, to);
  guard.lock();
}

} // namespace roscell::ros2
