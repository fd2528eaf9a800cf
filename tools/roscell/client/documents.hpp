#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"
#include "tools/roscell/client/document_parts.hpp"
#include "tools/roscell/client/file_values.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace roscell::cli {

/// A node takes far less; larger ones are refused there with a better error.
constexpr size_t max_document_bytes = 256UL * 1024 * 1024;

/// The bytes of a file, or of standard input for "-". Throws command_error if
/// it cannot be read, or is larger.
std::string read_file(const std::string& name,
                      size_t max_bytes = max_document_bytes);

/// What a node that stands on paper only may leave out: it uses nothing, has no
/// GPU, label or device, and no unified memory. What is wrong with the document
/// is for the schema to say.
void complete_paper_node(json& node);

/// A file with a task request, or a plan document with one, as somebody wrote
/// it.
struct task_file {
  std::string name; ///< "-" for standard input.
  std::string text;
  json document;
  /// JSON pointer of the request in the document: "" or "/request".
  std::string request_at;
  /// JSON pointer of the document in the text.
  std::string document_at = {};

  /// The request itself, with its "type".
  json request() const;
};

/// Reads such a file and fills in its variables. Throws wrong_document if it
/// cannot be parsed or filled in, and command_error if it cannot be read.
task_file read_task_file(const std::string& name, const file_values& values);

/// The task requests of a file, which may hold several documents: parted by
/// `---` lines in YAML, as a list in JSON. Each may say `kind: task`. Throws as
/// above; variables are those of each document.
std::vector<task_file> read_task_files(const std::string& name,
                                       const file_values& values);

/// A document is refused: what is wrong is shown with marks under the places.
class wrong_document : public std::runtime_error {
public:
  wrong_document(task_file file, failure why)
      : std::runtime_error{why.message}, file{std::move(file)},
        why{within(std::move(why), this->file.document_at)} {}

  task_file file;
  failure why;
};

/// Does `command`, and shows why its document was refused, if it was: marks on
/// standard error, or the JSON error on standard output.
template <class Command>
int with_marks(bool as_json, Command command);

/// Shows it, and returns the exit code.
int show_wrong_document(const wrong_document& e, bool as_json);

template <class Command>
int with_marks(bool as_json, Command command) {
  try {
    return command();
  } catch (const wrong_document& e) {
    return show_wrong_document(e, as_json);
  }
}

} // namespace roscell::cli
