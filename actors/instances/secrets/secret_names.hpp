#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

/// The names of the secrets that a node has at present, for all threads that
/// want them. The keeper sets them.
class secret_names {
public:
  std::vector<std::string> get() const {
    const std::lock_guard guard{mutex_};
    return now_;
  }

  void set(std::vector<std::string> next) {
    const std::lock_guard guard{mutex_};
    now_ = std::move(next);
  }

private:
  mutable std::mutex mutex_;
  std::vector<std::string> now_;
};

using shared_secret_names = std::shared_ptr<secret_names>;

} // namespace roscell
