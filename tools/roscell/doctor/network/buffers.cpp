#include "tools/roscell/doctor/network/buffers.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/view/format.hpp"

#include <sys/socket.h>

#include <algorithm>

namespace roscell::cli {

namespace {

/// The kernel tells twice of what it gives, for its own books.
int64_t given_buffer(int fd, int name) {
  int wanted = wanted_buffer_bytes;
  socklen_t size = sizeof wanted;
  setsockopt(fd, SOL_SOCKET, name, &wanted, size);
  int told = 0;
  return getsockopt(fd, SOL_SOCKET, name, &told, &size) == 0 ? told / 2 : 0;
}

/// 1280x960 in colour.
constexpr int64_t image_bytes = 1280L * 960 * 3;

} // namespace

buffer_facts look_at_buffers() {
  const unique_fd fd{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (!fd)
    return {};
  return {given_buffer(fd.get(), SO_RCVBUF), given_buffer(fd.get(), SO_SNDBUF)};
}

finding judge_buffers(const buffer_facts& given) {
  const auto least = std::min(given.receive, given.send);
  const auto receive = format_bytes(static_cast<double>(given.receive));
  const auto send = format_bytes(static_cast<double>(given.send));
  const auto seen = "a socket gets " + receive + " to receive and " + send
                    + " to send, of 8 MiB that skills ask for";
  if (least >= wanted_buffer_bytes)
    return {judgement::ok, seen};
  const auto image = format_bytes(static_cast<double>(image_bytes));
  return {judgement::warning, seen,
          given.receive < image_bytes
              ? "an image of 1280x960 in colour has " + image
                    + ": best-effort readers lose some when the host is busy"
              : "several images of " + image
                    + " at once do not find room: best-effort readers lose "
                      "some when the host is busy",
          "sysctl -w net.core.rmem_max=8388608 net.core.wmem_max=8388608"};
}

findings examine_buffers(const examined_host& /*host*/) {
  return {judge_buffers(look_at_buffers())};
}

} // namespace roscell::cli
