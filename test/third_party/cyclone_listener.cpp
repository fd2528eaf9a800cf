// What a DDS implementation that is not ours sees from where it stands: joins
// domain 0 with Cyclone DDS, by simple discovery, and prints what it discovers,
// and what it reads of one topic of type sensor_msgs/msg/CameraInfo. One JSON
// line each, the first when it listens.
//
// Usage: cyclone_listener ADDRESS TOPIC [PEER]
// ADDRESS is of this host, TOPIC a ROS 2 name, PEER "ADDRESS:PORT" of another
// participant, which is then asked beside the multicast group. Ends on SIGTERM.

#include "camera_info.h"

#include <dds/dds.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace {

dds_entity_t check(dds_entity_t result, const char* what) {
  if (result < 0)
    throw std::runtime_error{std::string{what} + ": " + dds_strretcode(result)};
  return result;
}

std::string configuration(const std::string& address, const std::string& peer) {
  auto result = "<General><Interfaces><NetworkInterface address=\"" + address
                + "\"/></Interfaces></General>";
  if (!peer.empty())
    result += "<Discovery><Peers><Peer Address=\"" + peer
              + "\"/></Peers></Discovery>";
  return result;
}

std::string text(const dds_guid_t& guid) {
  std::string result;
  char byte[3];
  for (const auto value : guid.v) {
    std::snprintf(byte, sizeof byte, "%02x", value);
    result += byte;
  }
  return result;
}

/// The participant that listens, which is not to be told of.
dds_guid_t self;

bool is_self(const dds_guid_t& participant) {
  return std::memcmp(participant.v, self.v, sizeof self.v) == 0;
}

/// Calls `use` with each living sample that has come.
template <class Sample, class Use>
void take(dds_entity_t reader, Use use) {
  void* data = nullptr;
  dds_sample_info_t info;
  while (dds_take(reader, &data, &info, 1, 1) == 1) {
    if (info.valid_data && info.instance_state == DDS_IST_ALIVE)
      use(*static_cast<const Sample*>(data));
    dds_return_loan(reader, &data, 1);
  }
}

void on_participant(dds_entity_t reader, void*) {
  take<dds_builtintopic_participant_t>(reader, [](const auto& seen) {
    if (!is_self(seen.key))
      std::printf("{\"seen\":\"participant\",\"guid\":\"%s\"}\n",
                  text(seen.key).c_str());
  });
}

/// `kind` is the word for what is discovered.
void on_endpoint(dds_entity_t reader, void* kind) {
  take<dds_builtintopic_endpoint_t>(reader, [&](const auto& seen) {
    if (!is_self(seen.participant_key))
      std::printf("{\"seen\":\"%s\",\"guid\":\"%s\",\"topic\":\"%s\","
                  "\"type\":\"%s\"}\n",
                  static_cast<const char*>(kind), text(seen.key).c_str(),
                  seen.topic_name, seen.type_name);
  });
}

void on_sample(dds_entity_t reader, void*) {
  take<sensor_msgs_msg_dds__CameraInfo_>(reader, [](const auto& seen) {
    std::printf("{\"seen\":\"sample\",\"frame_id\":\"%s\",\"width\":%u}\n",
                seen.header.frame_id, seen.width);
  });
}

dds_entity_t listen(dds_entity_t participant, dds_entity_t topic,
                    const dds_qos_t* qos, dds_on_data_available_fn act,
                    const char* argument = nullptr) {
  auto* listener = dds_create_listener(const_cast<char*>(argument));
  dds_lset_data_available(listener, act);
  const auto result = dds_create_reader(participant, topic, qos, listener);
  dds_delete_listener(listener);
  return check(result, "reader");
}

void run(const std::string& address, const std::string& topic_name,
         const std::string& peer) {
  check(dds_create_domain(0, configuration(address, peer).c_str()), "domain");
  const auto participant =
      check(dds_create_participant(0, nullptr, nullptr), "participant");
  check(dds_get_guid(participant, &self), "GUID");
  listen(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr,
         on_participant);
  listen(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, on_endpoint,
         "writer");
  listen(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr, on_endpoint,
         "reader");
  const auto topic = check(
      dds_create_topic(participant, &sensor_msgs_msg_dds__CameraInfo__desc,
                       ("rt" + topic_name).c_str(), nullptr, nullptr),
      "topic");
  // Matches every writer.
  auto* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
  listen(participant, topic, qos, on_sample);
  dds_delete_qos(qos);
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fputs("usage: cyclone_listener ADDRESS TOPIC [PEER]\n", stderr);
    return 2;
  }
  // Before any thread is there, so that all of them leave it to `sigwait`.
  sigset_t ending;
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &ending, nullptr);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    run(argv[1], argv[2], argc == 4 ? argv[3] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cyclone_listener: %s\n", error.what());
    return 1;
  }
  std::puts("{\"listening\":true}");
  int signal = 0;
  sigwait(&ending, &signal);
  dds_delete(DDS_CYCLONEDDS_HANDLE);
}
