#pragma once

#include "skills/ros2/flow/pace.hpp"
#include "skills/ros2/participant_config.hpp"
#include "skills/ros2/topic_qos.hpp"

#include <fastdds/dds/core/policy/QosPolicies.hpp>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include <memory>
#include <string>

/// INTERNAL to this folder: our settings in the words of Fast DDS.
namespace roscell::ros2 {

/// Its datagrams leave when `pacer` lets them; `on_listening` is called while
/// the participant is made. Throws engine::start_error when a discovery server
/// cannot be reached, or this host has no UDP port to listen on.
eprosima::fastdds::dds::DomainParticipantQos to_participant_qos(
    const participant_config& config,
    std::shared_ptr<datagram_pacer> pacer = std::make_shared<datagram_pacer>(),
    port_handler on_listening = {});

eprosima::fastdds::dds::DataReaderQos to_reader_qos(const topic_qos& qos);

eprosima::fastdds::dds::DataWriterQos to_writer_qos(const topic_qos& qos);

// INTERNAL to this folder: what an instance's log says of its topics.

/// "'/scene_1/image': a writer has come, there is 1 now". `change` may be
/// negative.
std::string matched_text(const std::string& topic, const std::string& peer,
                         int count, int change);

/// Which parameter makes the two ends agree.
std::string incompatible_text(const std::string& topic, const std::string& peer,
                              eprosima::fastdds::dds::QosPolicyId_t policy);

} // namespace roscell::ros2
