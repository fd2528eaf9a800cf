#include "actors/edge/exec/engine_frames.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

namespace {

std::string frame(char stream, const std::string& bytes) {
  std::string result(8, '\0');
  result[0] = stream;
  result[6] = static_cast<char>(bytes.size() / 256);
  result[7] = static_cast<char>(bytes.size() % 256);
  return result + bytes;
}

} // namespace

TEST_CASE("frames of an engine are told apart, however they are cut") {
  const auto all = frame(1, "out") + frame(2, "err") + frame(1, "")
                   + frame(0, std::string(300, 'x')) + frame(2, "!");
  for (size_t cut = 1; cut < all.size(); ++cut) {
    engine_frames x;
    std::array<std::string, 2> outputs;
    for (size_t at = 0; at < all.size(); at += cut)
      REQUIRE(x.take(std::string_view{all}.substr(at, cut), outputs));
    CHECK(outputs[0] == "out" + std::string(300, 'x'));
    CHECK(outputs[1] == "err!");
  }
}

TEST_CASE("what is no frame ends the stream") {
  for (const auto* head : {"\3\0\0\0\0\0\0\1", "\1\0\1\0\0\0\0\1"}) {
    engine_frames x;
    std::array<std::string, 2> outputs;
    CHECK_FALSE(x.take({head, 8}, outputs));
    CHECK_FALSE(x.take(frame(1, "out"), outputs));
    CHECK(outputs[0].empty());
  }
}

TEST_CASE("an engine's answer begins with a head") {
  CHECK(read_answer_head("HTTP/1.1 101 UPGRADED\r\nUpgrade: tcp").bytes == 0);
  const std::string head = "HTTP/1.1 101 UPGRADED\r\nUpgrade: tcp\r\n\r\n";
  CHECK(read_answer_head(head + "bytes").status == 101);
  CHECK(read_answer_head(head + "bytes").bytes == head.size());
  CHECK(read_answer_head("HTTP/1.1 \r\n\r\n").status == 0);
  CHECK(read_answer_head("nonsense\r\n\r\n").status == 0);
}
