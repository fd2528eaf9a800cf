#include "actors/edge/dds/site_survey.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace roscell {

namespace {

/// What was seen so far. One thread waits; Fast DDS's thread tells.
class survey {
public:
  explicit survey(const std::function<bool(const announcement&)>& enough)
      : enough_(enough) {}

  void add(const announcement& said) {
    std::lock_guard<std::mutex> lock{mutex_};
    drop(said);
    seen_.push_back(said);
    if (enough_ && enough_(said)) {
      over_ = true;
      changed_.notify_one();
    }
  }

  void remove(const announcement& said) {
    std::lock_guard<std::mutex> lock{mutex_};
    drop(said);
  }

  std::vector<announcement> wait(std::chrono::milliseconds span) {
    std::unique_lock<std::mutex> lock{mutex_};
    changed_.wait_for(lock, span, [this] { return over_; });
    return seen_;
  }

private:
  /// A later word of one that has spoken replaces the former. Where it is is a
  /// part of who it is: another one may say the rest as well.
  void drop(const announcement& said) {
    auto same = [&](const announcement& x) {
      return x.uuid == said.uuid && x.node == said.node && x.role == said.role
             && x.session == said.session;
    };
    seen_.erase(std::remove_if(seen_.begin(), seen_.end(), same), seen_.end());
  }

  const std::function<bool(const announcement&)>& enough_;
  std::mutex mutex_; // Guards what follows.
  std::condition_variable changed_;
  bool over_ = false;
  std::vector<announcement> seen_;
};

} // namespace

edge_result<std::vector<announcement>>
survey_site(presence_options options, std::chrono::milliseconds span,
            const std::function<bool(const announcement&)>& enough) {
  announcement self;
  self.role = "surveyor";
  options.announcement = encode(self);
  survey found{enough};
  presence_events events;
  events.on_seen = [&](const announcement& said) { found.add(said); };
  events.on_gone = [&](const announcement& said) { found.remove(said); };
  auto presence = public_presence::open(options, std::move(events));
  if (auto* error = std::get_if<edge_error>(&presence))
    return *error;
  auto result = found.wait(span);
  std::get<0>(presence)->close();
  return result;
}

} // namespace roscell
