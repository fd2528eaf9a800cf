// Lets a participant that knows simple discovery only, such as one of Cyclone
// DDS, register with a Fast DDS discovery server. It adds what such a server
// asks of its clients and the RTPS standard does not have:
//
//  - its participant is of the same vendor, and a client (PARTICIPANT_TYPE);
//  - each announcement names the sample it carries (parameter 0x800f);
//  - announcements of the server are acknowledged, although participant data is
//    best effort in the standard.
//
// To see both directions, it puts its own address in the place where the
// participant and the server tell each other where they listen for discovery.
// Data of topics does not pass here.
//
// Usage: server_gate ADDRESS SERVER_ADDRESS SERVER_PORT
// Prints the port on which it waits for the participant, whose peer it is to
// be. One participant, one server, little endian only.

#include "rtps_message.hpp"

#include <cstdio>
#include <cstdlib>
#include <set>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace {

using namespace rtps;

void append_text(std::string& to, const std::string& text) {
  append(to, static_cast<std::uint32_t>(text.size() + 1));
  to += text;
  to.append(4 - text.size() % 4, '\0');
}

/// What makes a participant a client, as parameters.
std::string client_parameters() {
  std::string list;
  append(list, std::uint32_t{2});
  for (const auto* word : {"PARTICIPANT_TYPE", "CLIENT", "DS_VERSION", "2.0"})
    append_text(list, word);
  std::string result;
  append(result, pid_vendor_id);
  append(result, std::uint16_t{4});
  result.append("\x01\x0f\0\0", 4);
  append(result, pid_property_list);
  append(result, static_cast<std::uint16_t>(list.size()));
  return result + list;
}

class gate {
public:
  gate(const char* address, const char* server_address, int server_port) {
    server_ = endpoint(server_address, server_port);
    auto here = endpoint(address, 0);
    socklen_t size = sizeof here;
    socket_ = ::socket(AF_INET, SOCK_DGRAM, 0);
    if (::bind(socket_, reinterpret_cast<sockaddr*>(&here), size) != 0) {
      std::perror("server_gate");
      std::exit(1);
    }
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&here), &size);
    here_ = locator(here);
    std::printf("%d\n", ntohs(here.sin_port));
    std::fflush(stdout);
  }

  void run() {
    for (;;) {
      std::string datagram(65536, '\0');
      const auto size = ::recv(socket_, datagram.data(), datagram.size(), 0);
      if (size < static_cast<ssize_t>(header_bytes))
        continue;
      datagram.resize(static_cast<std::size_t>(size));
      // What discovery servers are called begins so.
      if (datagram.compare(prefix_at, 2, "DS") == 0)
        from_server(datagram);
      else
        from_participant(datagram);
    }
  }

private:
  static sockaddr_in endpoint(const char* address, int port) {
    sockaddr_in result{};
    result.sin_family = AF_INET;
    result.sin_port = htons(static_cast<std::uint16_t>(port));
    ::inet_pton(AF_INET, address, &result.sin_addr);
    return result;
  }

  static std::string locator(const sockaddr_in& of) {
    std::string result;
    append(result, std::int32_t{1}); // UDP by IPv4.
    append(result, std::uint32_t{ntohs(of.sin_port)});
    result.append(12, '\0');
    append(result, of.sin_addr);
    return result;
  }

  void send(const std::string& bytes, const sockaddr_in& to) const {
    ::sendto(socket_, bytes.data(), bytes.size(), 0,
             reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

  void from_participant(const std::string& datagram) {
    participant_header_ = datagram.substr(0, header_bytes);
    send(map_submessages(datagram,
                         [&](submessage& part) {
                           if (part.kind != data)
                             return;
                           if (part.is_of_participant_writer())
                             learn_participant(part);
                           name_sample(part);
                         }),
         server_);
  }

  void from_server(const std::string& datagram) {
    const auto passed = map_submessages(datagram, [&](submessage& part) {
      if (part.is_of_participant_writer())
        on_participant_data(datagram, part);
    });
    if (participant_.sin_port != 0)
      send(passed, participant_);
  }

  /// Where the participant listens; this program takes that place.
  void learn_participant(submessage& part) {
    replace_locators(part, [this](const std::string& bytes, std::size_t at) {
      participant_ = endpoint("0.0.0.0", get<std::uint16_t>(bytes, at + 4));
      participant_.sin_addr = get<in_addr>(bytes, at + 20);
    });
    hide(part, pid_property_list);
    hide(part, pid_vendor_id);
    part.insert(part.payload(), client_parameters());
  }

  /// Turns parameters into padding.
  static void hide(submessage& part, std::uint16_t what) {
    walk_parameters(part.bytes, part.payload(), [&](auto id, auto at, auto) {
      if (id == what)
        part.bytes.replace(at - 4, 2, 2, '\0');
    });
  }

  template <class Use>
  void replace_locators(submessage& part, Use before) const {
    hide(part, pid_metatraffic_multicast);
    auto& bytes = part.bytes;
    walk_parameters(bytes, part.payload(), [&](auto id, auto at, auto size) {
      if (id == pid_metatraffic_unicast && size == here_.size()) {
        before(bytes, at);
        bytes.replace(at, size, here_);
      }
    });
  }

  /// Adds the sample's identity: its writer's GUID and its sequence number.
  void name_sample(submessage& part) const {
    std::string added;
    append(added, pid_sample_identity);
    append(added, std::uint16_t{24});
    added += participant_header_.substr(prefix_at, 12);
    added += part.bytes.substr(12, 4 + 8);
    if ((part.flags() & with_inline_qos) == 0) {
      append(added, pid_sentinel);
      append(added, std::uint16_t{0});
    }
    part.insert(submessage::inline_qos, added);
    part.bytes[1] = static_cast<char>(part.flags() | with_inline_qos);
  }

  void on_participant_data(const std::string& datagram, submessage& part) {
    if (part.kind == data) {
      received_.insert(get_number(part.bytes, 16));
      replace_locators(part, [](const auto&, auto) {});
    } else if (part.kind == gap) {
      const auto end = get_number(part.bytes, 20);
      for (auto i = get_number(part.bytes, 12); i < end && i < end_; ++i)
        received_.insert(i);
    } else if (part.kind == heartbeat) {
      acknowledge(datagram.substr(prefix_at, 12), get_number(part.bytes, 12),
                  get_number(part.bytes, 20));
    }
  }

  /// Asks for what is missing of `first` to `last`, at most 32 of them.
  void acknowledge(const std::string& server, std::int64_t first,
                   std::int64_t last) {
    if (participant_header_.empty())
      return;
    end_ = last + 1;
    auto base = first;
    while (base <= last && received_.count(base) != 0)
      ++base;
    const auto count = std::min<std::int64_t>(last - base + 1, 32);
    std::uint32_t missing = 0;
    for (std::int64_t i = 0; i < count; ++i)
      if (received_.count(base + i) == 0)
        missing |= 1U << (31 - i);
    auto reply = participant_header_;
    begin(reply, info_dst, 12);
    reply += server;
    begin(reply, acknack, count > 0 ? 28 : 24);
    reply.append(participant_reader, 4);
    reply.append(participant_writer, 4);
    append_number(reply, base);
    append(reply, static_cast<std::uint32_t>(count));
    if (count > 0)
      append(reply, missing);
    append(reply, ++acknowledgements_);
    send(reply, server_);
  }

  static void begin(std::string& message, std::uint8_t kind,
                    std::uint16_t size) {
    append(message, kind);
    append(message, little_endian);
    append(message, size);
  }

  int socket_ = -1;
  sockaddr_in server_{};
  sockaddr_in participant_{};
  std::string here_;               ///< As a locator.
  std::string participant_header_; ///< Of RTPS.
  std::set<std::int64_t> received_;
  std::int64_t end_ = 0; ///< After the server's last announcement.
  std::uint32_t acknowledgements_ = 0;
};

} // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: server_gate ADDRESS SERVER_ADDRESS SERVER_PORT\n",
               stderr);
    return 2;
  }
  gate{argv[1], argv[2], std::atoi(argv[3])}.run();
}
