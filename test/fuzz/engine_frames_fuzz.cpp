#include "actors/edge/exec/engine_frames.hpp"

#include <cstdlib>
#include <string_view>

/// Whatever an engine sends as the outputs of a command, no more comes out than
/// went in, and it does not matter how the bytes were cut on their way.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, size_t size) {
  using namespace roscell;
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  std::array<std::string, 2> whole;
  engine_frames at_once;
  const bool good = at_once.take(bytes, whole);
  std::array<std::string, 2> pieces;
  engine_frames in_pieces;
  bool good_pieces = true;
  for (size_t at = 0; at < size; at += 5)
    good_pieces = in_pieces.take(bytes.substr(at, 5), pieces);
  const auto head = read_answer_head(bytes);
  if (whole[0].size() + whole[1].size() > size
      || (size > 0 && good != good_pieces) || whole != pieces
      || head.bytes > size)
    std::abort();
  return 0;
}
