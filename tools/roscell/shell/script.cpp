#include "tools/roscell/shell/script.hpp"

#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/shell/child.hpp"
#include "tools/roscell/shell/json_collector.hpp"
#include "tools/roscell/split_words.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <optional>
#include <string>
#include <utility>

namespace roscell::cli {

namespace {

/// One script that is run.
class script_run {
public:
  explicit script_run(const connection_options& connection)
      : connection_{connection} {}

  /// The exit code of the line; none if nothing is done for it yet.
  std::optional<int> take(const std::string& line) {
    if (request_.is_open() || json_collector::begins(line))
      return take_json(line);
    const auto words = without_program(split_words(line).words);
    if (words.empty() || words.front().rfind('#', 0) == 0)
      return std::nullopt;
    ends_ = words.front() == "exit" || words.front() == "quit";
    return run_child(connection_, line, child_input::nothing);
  }

  /// Whether the script has said that it ends.
  bool ends() const {
    return ends_;
  }

  /// The exit code of what is left at the end of the script.
  int finish() const {
    return request_.is_open() ? send_by_child(connection_, request_)
                              : exit_done;
  }

private:
  std::optional<int> take_json(const std::string& line) {
    request_.add_line(line);
    if (request_.is_open())
      return std::nullopt;
    return send_by_child(connection_, std::exchange(request_, {}));
  }

  const connection_options& connection_;
  json_collector request_;
  bool ends_ = false;
};

void print_failure(size_t number, int code) {
  print_note("roscell: line " + std::to_string(number)
             + " has failed with exit code " + std::to_string(code));
}

} // namespace

int run_script(std::istream& lines, const connection_options& connection,
               bool keep_going) {
  script_run script{connection};
  int first_failure = exit_done;
  size_t number = 0;
  const auto failed = [&](int code) {
    if (code == exit_done)
      return false;
    print_failure(number, code);
    if (first_failure == exit_done)
      first_failure = code;
    return !keep_going;
  };
  for (std::string line; !script.ends() && std::getline(lines, line);) {
    ++number;
    if (failed(script.take(line).value_or(exit_done)))
      return first_failure;
  }
  failed(script.finish());
  return first_failure;
}

} // namespace roscell::cli
