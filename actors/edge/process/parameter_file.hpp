#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

/// How a program that runs is told that it is to work with other parameters: by
/// a FIFO beside its NOTIFY_SOCKET, of which the program alone reads. A program
/// that knows nothing of such changes does not open it, so that this is known
/// at once. Its answer comes on the NOTIFY_SOCKET, see `notification`.
namespace roscell {

/// Where it lies for a NOTIFY_SOCKET.
std::filesystem::path
parameter_file_of(const std::filesystem::path& notify_socket);

/// Makes one, before the program is started, in place of an older one.
void make_parameter_file(const std::filesystem::path& file);

/// The longest line that is written: what an empty FIFO takes at once.
constexpr size_t max_parameter_line_bytes = 60UL * 1024;

enum class parameter_delivery {
  written,
  no_file,     ///< The program was started by a node that makes none.
  no_listener, ///< The program does not read it.
  too_long,
  failed, ///< It holds what the program has not read, or cannot be written.
};

/// Writes all parameters, a JSON object, with the number that the answer will
/// name, as a line: {"number":7,"parameters":{...}}. Never blocks.
parameter_delivery write_parameters(const std::filesystem::path& file,
                                    int64_t number,
                                    const std::string& parameters);

/// Writes what has become of a request of the program, with its number, as a
/// line:
/// {"request":7,"problem":"a sentence"}. Never blocks.
/// @param problem empty: it is done.
parameter_delivery write_request_answer(const std::filesystem::path& file,
                                        int64_t number,
                                        const std::string& problem);

/// Both for an instance, wherever its runtime has the file.
using parameter_writer = std::function<parameter_delivery(
    const std::string& instance, int64_t number,
    const std::string& parameters)>;
using request_answerer = std::function<parameter_delivery(
    const std::string& instance, int64_t number, const std::string& problem)>;

} // namespace roscell
