#pragma once

#include "embedding/skills/frame_inbox.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace roscell::embedding {

/// The protocol "actor": frames that instances of one process pass on to each
/// other by pointer. May be used from any thread.
class frame_hub {
public:
  /// From now on the frames of `stream` go to that port. Ends with the inbox.
  void subscribe(const std::string& stream,
                 const std::shared_ptr<frame_inbox>& inbox, std::size_t port);

  void publish(const std::string& stream, const shared_frame& x);

private:
  struct reader {
    std::weak_ptr<frame_inbox> inbox;
    std::size_t port;
  };

  std::mutex mutex_;
  std::map<std::string, std::vector<reader>> readers_;
};

} // namespace roscell::embedding
