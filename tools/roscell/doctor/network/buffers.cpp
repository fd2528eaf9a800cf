#include "tools/roscell/doctor/network/buffers.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/view/format.hpp"

#include <sys/socket.h>

#include <algorithm>

namespace roscell::cli {

namespace {

/// The kernel tells twice of what it gives, for its own accounts.
int64_t given_buffer(int fd, int name) {
  int wanted = wanted_buffer_bytes;
  socklen_t size = sizeof wanted;
  setsockopt(fd, SOL_SOCKET, name, &wanted, size);
  int reported = 0;
  return getsockopt(fd, SOL_SOCKET, name, &reported, &size) == 0 ? reported / 2
                                                                 : 0;
}

} // namespace

buffer_readings read_buffers() {
  const unique_fd fd{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (!fd)
    return {};
  return {given_buffer(fd.get(), SO_RCVBUF), given_buffer(fd.get(), SO_SNDBUF)};
}

sent_image image_of(int64_t width, int64_t height) {
  constexpr int64_t bytes_of_colour = 3;
  return {"an image of " + std::to_string(width) + "x" + std::to_string(height)
              + " in colour",
          width * height * bytes_of_colour};
}

sent_image usual_image() {
  auto result = image_of(1280, 960);
  result.name += " (as is usual; `cameras` tells of those that flow)";
  return result;
}

finding judge_buffers(const buffer_readings& given, const sent_image& image) {
  const auto least = std::min(given.receive, given.send);
  const auto receive = format_bytes(static_cast<double>(given.receive));
  const auto send = format_bytes(static_cast<double>(given.send));
  const auto seen = "a socket gets " + receive + " to receive and " + send
                    + " to send, of 8 MiB that skills ask for";
  if (least >= std::max(wanted_buffer_bytes, image.bytes))
    return {judgement::ok, seen};
  const auto size =
      image.name + " has " + format_bytes(static_cast<double>(image.bytes));
  const auto wanted =
      std::to_string(std::max(wanted_buffer_bytes, image.bytes));
  return {judgement::warning, seen,
          size
              + (given.receive < image.bytes
                     ? ": best-effort readers lose some when the host is busy"
                     : ", and several at once do not find room: best-effort "
                       "readers lose some when the host is busy"),
          "sudo sysctl -w net.core.rmem_max=" + wanted
              + " net.core.wmem_max=" + wanted};
}

findings check_buffers(const checked_host& /*host*/) {
  return {judge_buffers(read_buffers())};
}

} // namespace roscell::cli
