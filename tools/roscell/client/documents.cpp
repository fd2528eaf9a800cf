#include "tools/roscell/client/documents.hpp"

#include "schemas/document.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/marked_errors.hpp"
#include "tools/roscell/view/plan_view.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>
#include <variant>

namespace roscell::cli {

namespace {

std::string read_all(int fd, const std::string& name, size_t max_bytes) {
  std::string text;
  std::array<char, 65536> buffer{};
  while (true) {
    const auto n = read(fd, buffer.data(), buffer.size());
    if (n == 0)
      return text;
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      throw command_error{exit_usage,
                          "cannot read " + name + ": " + std::strerror(errno)};
    text.append(buffer.data(), static_cast<size_t>(n));
    if (text.size() > max_bytes)
      throw command_error{exit_usage, name + " is larger than "
                                          + format_bytes(double(max_bytes))};
  }
}

/// Closes what it was given.
struct open_file {
  int fd;
  explicit open_file(const std::string& name)
      : fd{open(name.c_str(), O_RDONLY | O_CLOEXEC)} {}
  ~open_file() {
    if (fd >= 0)
      close(fd);
  }
  open_file(const open_file&) = delete;
  open_file& operator=(const open_file&) = delete;
};

} // namespace

std::string read_file(const std::string& name, size_t max_bytes) {
  if (name == "-") {
    if (isatty(STDIN_FILENO) == 1)
      print_note("reading the request from the terminal; Ctrl-D ends it");
    return read_all(STDIN_FILENO, "standard input", max_bytes);
  }
  const open_file file{name};
  if (file.fd < 0)
    throw command_error{exit_usage,
                        "cannot read " + name + ": " + std::strerror(errno)};
  return read_all(file.fd, name, max_bytes);
}

namespace {

void add_missing(json& object, const char* name, json value) {
  if (!object.contains(name))
    object[name] = std::move(value);
}

/// Nothing is used of an amount that does not say so.
void complete_amount(json& owner, const char* name) {
  const auto amount = owner.find(name);
  if (amount != owner.end() && amount->is_object())
    add_missing(*amount, "used", 0);
}

} // namespace

void complete_paper_node(json& node) {
  if (!node.is_object())
    return;
  add_missing(node, "unified_memory", false);
  add_missing(node, "gpus", json::array());
  add_missing(node, "labels", json::object());
  add_missing(node, "devices", json::array());
  for (const auto* name : {"cpu", "memory_mib", "disk_mib"})
    complete_amount(node, name);
  auto& gpus = node["gpus"];
  if (gpus.is_array())
    for (auto& gpu : gpus)
      if (gpu.is_object())
        complete_amount(gpu, "memory_mib");
}

json task_file::request() const {
  auto result = request_at.empty() ? document : document.at("request");
  if (result.is_object())
    result["type"] =
        result.contains("for_each") ? "task_set_request" : "task_request";
  return result;
}

namespace {

/// Parses the text of a file, which is one document.
json parsed(const task_file& file, document_format format) {
  auto result = parse_document(file.text, format);
  if (auto* why = std::get_if<failure>(&result))
    throw wrong_document{file, std::move(*why)};
  return std::get<json>(std::move(result));
}

/// Fills in what the file's document leaves open.
void fill(task_file& file, json document, const file_values& values) {
  auto result = fill_from(std::move(document), values);
  if (auto* why = std::get_if<failure>(&result))
    throw wrong_document{file, std::move(*why)};
  file.document = std::get<json>(std::move(result));
}

/// A task may say that it is one, for cells have documents, too. Another kind
/// stays for the schema to refuse.
void take_kind(task_file& file) {
  auto& document = file.document;
  if (document.is_object() && document.value("kind", json{}) == "task")
    document.erase("kind");
}

void expect_task(const task_file& file) {
  const auto& document = file.document;
  if (document.is_object() && document.contains("kind"))
    throw wrong_document{file,
                         {error_code::schema_violation,
                          "expected the kind \"task\"", "/kind",
                          "`roscell cell apply` takes the document of a cell"}};
}

} // namespace

task_file read_task_file(const std::string& name, const file_values& values) {
  task_file result{name, read_file(name), {}, {}};
  fill(result, parsed(result, format_of(name, result.text)), values);
  take_kind(result);
  if (result.document.is_object() && result.document.contains("request"))
    result.request_at = "/request";
  return result;
}

std::vector<task_file> read_task_files(const std::string& name,
                                       const file_values& values) {
  const auto text = read_file(name);
  std::vector<task_file> result;
  if (format_of(name, text) == document_format::yaml) {
    for (auto& part : yaml_documents(text)) {
      result.push_back({name, std::move(part), {}, {}});
      auto& file = result.back();
      fill(file, parsed(file, document_format::yaml), values);
      take_kind(file);
      expect_task(file);
    }
    return result;
  }
  const task_file whole{name, text, {}, {}};
  const auto document = parsed(whole, document_format::json);
  const auto count = document.is_array() ? document.size() : 1;
  for (size_t i = 0; i < count; ++i) {
    result.push_back({name, text, {}, {}});
    auto& file = result.back();
    if (document.is_array())
      file.document_at = "/" + std::to_string(i);
    fill(file, document.is_array() ? document[i] : document, values);
    take_kind(file);
    expect_task(file);
  }
  return result;
}

namespace {

/// The marks, or the rejected candidates, say what is wrong, so the hint that
/// they are there says nothing. What else may be done stands behind it.
std::string hint_beside(const failure& why, bool has_rejected) {
  if (why.code == error_code::schema_violation)
    return {};
  if (!has_rejected)
    return why.hint;
  const auto more = why.hint.find("; ");
  return more == std::string::npos ? "" : why.hint.substr(more + 2);
}

void show_places(const wrong_document& e, const json& reply) {
  const auto marks = marked_errors(e.file.name, e.file.text, reply);
  const auto rejected = rejected_in(e.why);
  if (!rejected.empty())
    print_text(rejected_view(rejected, stdout_style()));
  if (marks.empty())
    return print_refusal(reply);
  print_text(marks);
  print_log_tail(e.why.details);
  const auto hint = hint_beside(e.why, !rejected.empty());
  if (!hint.empty())
    print_note("hint: " + printable(hint));
}

} // namespace

int show_wrong_document(const wrong_document& e, bool as_json) {
  const auto reply = error_reply(e.why);
  if (as_json)
    print(pretty(reply));
  else
    show_places(e, reply);
  return exit_code_of_refusal(reply);
}

} // namespace roscell::cli
