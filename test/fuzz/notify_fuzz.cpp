#include "actors/edge/process/notification.hpp"
#include "schemas/utf8.hpp"

#include <cstdlib>
#include <string_view>

/// Whatever a program says, its status is one short line of valid UTF-8.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, size_t size) {
  using namespace roscell;
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  const auto words = parse_notification(bytes);
  if (words.status.size() > max_status_bytes
      || words.status.find('\n') != std::string::npos
      || valid_utf8(words.status) != words.status
      || unfinished_utf8(words.status) != 0)
    std::abort();
  const auto text = valid_utf8(bytes);
  if (valid_utf8(text) != text || unfinished_utf8(bytes) > 3)
    std::abort();
  return 0;
}
