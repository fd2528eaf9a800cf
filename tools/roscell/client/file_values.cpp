#include "tools/roscell/client/file_values.hpp"

#include "schemas/document.hpp"
#include "schemas/text_excerpt.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/exit_code.hpp"

#include <CLI/CLI.hpp>

#include <utility>
#include <variant>

namespace roscell::cli {

namespace {

json values_in(const std::string& file) {
  const auto text = read_file(file);
  auto parsed = parse_document(text, format_of(file, text));
  if (const auto* why = std::get_if<failure>(&parsed))
    throw command_error{exit_usage, file + ": " + why->message};
  auto& document = std::get<json>(parsed);
  if (!document.is_object())
    throw command_error{exit_usage,
                        file + ": expected values by name, but it is "
                            + shown_value(document),
                        "write one in each line: rate_hz: 5"};
  return std::move(document);
}

} // namespace

given_values file_values::read() const {
  given_values result;
  for (const auto& file : files)
    result.typed.update(values_in(file));
  for (const auto& word : set) {
    const auto equals = word.find('=');
    if (equals == std::string::npos || equals == 0)
      throw command_error{exit_usage,
                          "--set " + in_quotes(word) + ": expected NAME=VALUE"};
    result.words[word.substr(0, equals)] = word.substr(equals + 1);
  }
  return result;
}

void add_value_options(CLI::App& command, file_values& values) {
  command
      .add_option("--set", values.set,
                  "Give a variable of the file this value; may be repeated")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--values", values.files,
                  "Take values of the file's variables from this one; may be "
                  "repeated")
      ->option_text("FILE")
      ->allow_extra_args(false);
}

std::variant<json, failure> fill_from(json document,
                                      const file_values& values) {
  return fill_variables(std::move(document), values.read());
}

} // namespace roscell::cli
