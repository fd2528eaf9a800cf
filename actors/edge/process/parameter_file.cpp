#include "actors/edge/process/parameter_file.hpp"

#include "actors/edge/io/fifo.hpp"
#include "schemas/document.hpp"

#include <unistd.h>

namespace roscell {

namespace fs = std::filesystem;

fs::path parameter_file_of(const fs::path& notify_socket) {
  return notify_socket.native() + ".parameters";
}

void make_parameter_file(const fs::path& file) {
  make_fifo(file);
}

namespace {

/// What an earlier line has left behind, of which there was room for a part
/// only, ends at the first end of line.
parameter_delivery write_line(const fs::path& file, const std::string& text) {
  const auto line = "\n" + text + "\n";
  if (line.size() > max_parameter_line_bytes)
    return parameter_delivery::too_long;
  const auto fifo = open_fifo_to_write(file);
  if (!fifo)
    return fifo.is_there ? parameter_delivery::no_listener
                         : parameter_delivery::no_file;
  const bool is_whole = ::write(fifo.out.get(), line.data(), line.size())
                        == static_cast<ssize_t>(line.size());
  return is_whole ? parameter_delivery::written : parameter_delivery::failed;
}

} // namespace

parameter_delivery write_parameters(const fs::path& file, int64_t number,
                                    const std::string& parameters) {
  return write_line(file, "{\"number\":" + std::to_string(number)
                              + ",\"parameters\":" + parameters + "}");
}

parameter_delivery write_request_answer(const fs::path& file, int64_t number,
                                        const std::string& problem) {
  const json answer{{"request", number}, {"problem", problem}};
  return write_line(
      file, answer.dump(-1, ' ', false, json::error_handler_t::replace));
}

} // namespace roscell
