#include "actors/edge/dds/discovery_setup.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <fastrtps/xmlparser/XMLProfileManager.h>

#include <cstdlib>
#include <memory>
#include <utility>

namespace roscell {

namespace {

using eprosima::fastdds::dds::Log;

class forwarding_consumer : public eprosima::fastdds::dds::LogConsumer {
public:
  explicit forwarding_consumer(std::function<void(const std::string&)> to)
      : to_(std::move(to)) {}

  void Consume(const Log::Entry& entry) override {
    to_(entry.message);
  }

private:
  std::function<void(const std::string&)> to_;
};

} // namespace

void prepare_dds_environment(std::function<void(const std::string&)> on_error) {
  for (const char* name : {"ROS_DISCOVERY_SERVER", "FASTDDS_ENVIRONMENT_FILE",
                           "FASTRTPS_DEFAULT_PROFILES_FILE"})
    unsetenv(name);
  setenv("SKIP_DEFAULT_XML", "1", 1);
  // Servers of two cells may have the same id, and so their GUID prefixes; in
  // one process Fast DDS would take the one for the other.
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery =
      eprosima::fastrtps::IntraprocessDeliveryType::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
  Log::ClearConsumers();
  Log::SetVerbosity(Log::Error);
  if (on_error)
    Log::RegisterConsumer(
        std::make_unique<forwarding_consumer>(std::move(on_error)));
}

} // namespace roscell
