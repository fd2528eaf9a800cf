#include "actors/house/house.hpp"

#include "messages/messages.hpp"

namespace roscell {

void house::tell(std::string what, std::string subject,
                 const json& data) const {
  if (events)
    caf::anon_send(events,
                   record_event{std::move(what), std::move(subject),
                                data.is_null() ? std::string{} : data.dump()});
}

} // namespace roscell
