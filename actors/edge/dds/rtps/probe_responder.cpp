#include "actors/edge/dds/rtps/probe_responder.hpp"

#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/participant_news.hpp"

#include <sys/socket.h>

namespace roscell {

void probe_responder::speak_for(const guid_prefix& server,
                                const std::string& announcement) {
  std::lock_guard<std::mutex> lock{mutex_};
  reply_ = probe_reply(server, announcement);
}

bool probe_responder::take(std::uint8_t* message, std::size_t size,
                           const sockaddr_in& from) {
  const auto sender = probe_answer(message, size);
  if (!sender)
    return false;
  std::lock_guard<std::mutex> lock{mutex_};
  const auto said = own_announcement_in(message, size);
  if (!said || said->name != probe_name)
    return asked_.count(*sender) != 0;
  if (reply_.empty())
    return false;
  remember(*sender);
  // Who gets no answer asks again.
  sendto(socket_.fd(), reply_.data(), reply_.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&from), sizeof(from));
  return true;
}

void probe_responder::remember(const guid_prefix& who) {
  if (!asked_.insert(who).second)
    return;
  in_order_.push_back(who);
  if (in_order_.size() > most_remembered) {
    asked_.erase(in_order_.front());
    in_order_.pop_front();
  }
}

} // namespace roscell
