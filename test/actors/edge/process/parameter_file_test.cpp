#include "actors/edge/process/parameter_file.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <fstream>
#include <string>

using namespace roscell;
using namespace roscell::test;

namespace {

unique_fd open_as_program(const std::filesystem::path& file) {
  return unique_fd{::open(file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)};
}

std::string read_by(const unique_fd& program) {
  std::string result(100'000, '\0');
  const auto size = ::read(program.get(), result.data(), result.size());
  result.resize(size > 0 ? static_cast<size_t>(size) : 0);
  return result;
}

} // namespace

TEST_CASE("a program is told all parameters with a number, on a line") {
  temp_folder folder;
  const auto file = parameter_file_of(folder.path() / "notify");
  CHECK(file == folder.path() / "notify.parameters");
  make_parameter_file(file);
  const auto program = open_as_program(file);
  CHECK(write_parameters(file, 7, R"({"a":1})") == parameter_delivery::written);
  CHECK(read_by(program) == "\n{\"number\":7,\"parameters\":{\"a\":1}}\n");
}

TEST_CASE("a program is told what has become of its request, on a line") {
  temp_folder folder;
  const auto file = parameter_file_of(folder.path() / "notify");
  make_parameter_file(file);
  const auto program = open_as_program(file);
  CHECK(write_request_answer(file, 7, "no\n\xff")
        == parameter_delivery::written);
  CHECK(read_by(program)
        == "\n{\"problem\":\"no\\n\xef\xbf\xbd\",\"request\":7}\n");
}

TEST_CASE("who cannot be told of parameters is known, and why") {
  temp_folder folder;
  const auto file = folder.path() / "notify.parameters";
  CHECK(write_parameters(file, 7, "{}") == parameter_delivery::no_file);
  std::ofstream{file} << "mine";
  CHECK(write_parameters(file, 7, "{}") == parameter_delivery::no_file);
  make_parameter_file(file);
  CHECK(write_parameters(file, 7, "{}") == parameter_delivery::no_listener);
}

TEST_CASE("parameters that an empty file takes are told at once, others not") {
  temp_folder folder;
  const auto file = folder.path() / "notify.parameters";
  make_parameter_file(file);
  const auto program = open_as_program(file);
  const auto of_bytes = [](size_t n) {
    return R"({"a":")" + std::string(n, 'x') + R"("})";
  };
  const auto most = max_parameter_line_bytes - 100;
  CHECK(write_parameters(file, 1, of_bytes(most + 100))
        == parameter_delivery::too_long);
  CHECK(write_parameters(file, 2, of_bytes(most))
        == parameter_delivery::written);
  // It does not read.
  CHECK(write_parameters(file, 3, of_bytes(most))
        == parameter_delivery::failed);
  // What has come of the third does not spoil the next one.
  read_by(program);
  read_by(program);
  CHECK(write_parameters(file, 4, "{}") == parameter_delivery::written);
  CHECK(read_by(program) == "\n{\"number\":4,\"parameters\":{}}\n");
}
