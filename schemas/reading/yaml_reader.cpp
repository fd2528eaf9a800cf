#include "schemas/reading/yaml_reader.hpp"

#include "schemas/text_excerpt.hpp"
#include "schemas/utf8.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace roscell {

namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// Ends the parser, which knows no other way.
struct end_of_reading {};

/// The tags that the parser gives to what has none.
constexpr std::string_view plain_tag = "?";
constexpr std::string_view quoted_tag = "!";

/// Bytes from `begin` on that are a scalar, as far as they are on one line: in
/// quotes up to those that end it, else as much as the value is written there.
/// Of the block that follows `|` or `>` only that sign.
size_t scalar_length(std::string_view text, size_t begin,
                     std::string_view value) {
  const auto rest = text.substr(std::min(begin, text.size()));
  if (rest.empty())
    return 0;
  const auto quote = rest.front();
  if (quote != '"' && quote != '\'') {
    const auto [end, ignored] =
        std::mismatch(rest.begin(), rest.end(), value.begin(), value.end());
    return static_cast<size_t>(end - rest.begin());
  }
  size_t i = 1;
  for (; i < rest.size(); ++i) {
    const bool is_escape = quote == '"'
                               ? rest[i] == '\\'
                               : rest.substr(i, 2) == std::string_view{"''"};
    if (is_escape)
      ++i;
    else if (rest[i] == quote)
      return i + 1;
  }
  return rest.size();
}

/// Passes the parser's events on, and refuses what JSON cannot say.
class yaml_events final : public YAML::EventHandler {
public:
  /// `skipped` is how many bytes of the text the parser is not given.
  yaml_events(std::string_view text, size_t skipped, document_events& to)
      : text_(text), skipped_(skipped), to_(to) {
    // nop
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (has_document_)
      refuse(mark, "a second document begins here; expected one");
    has_document_ = true;
  }

  void OnDocumentEnd() override {
    // nop
  }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    scalar(mark, nullptr, 0);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark, "aliases (*) are not taken; write the value itself");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag,
                YAML::anchor_t anchor, const std::string& value) override {
    refuse_anchor(mark, anchor);
    // The parser writes the characters of two escapes as single bytes.
    if (valid_utf8_prefix(value) < value.size())
      refuse(mark, "the escapes \\N and \\_ are not taken; write the "
                   "characters themselves, or \\u0085 and \\u00a0");
    const auto length = scalar_length(text_, offset(mark), value);
    if (tag == quoted_tag)
      return scalar(mark, value, length);
    refuse_tag(mark, tag);
    auto meant = plain_scalar(value);
    if (!meant)
      refuse(mark, "JSON has no such number; expected one that a 64-bit "
                   "floating-point number can hold");
    scalar(mark, std::move(*meant), length);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag,
                       YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    open(mark, json::array());
  }

  void OnSequenceEnd() override {
    close();
  }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag,
                  YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    open(mark, json::object());
  }

  void OnMapEnd() override {
    close();
  }

  bool has_document() const {
    return has_document_;
  }

  /// The byte that a mark stands for; the end of the text if for none.
  size_t offset(const YAML::Mark& mark) const {
    return mark.is_null() ? text_.size()
                          : skipped_ + static_cast<size_t>(mark.pos);
  }

private:
  /// A sequence or mapping that is still open.
  struct level {
    bool is_mapping;
    bool wants_name; ///< What comes next is the name of a member.
  };

  [[noreturn]] void refuse(const YAML::Mark& mark, std::string words) {
    to_.fail({offset(mark), std::move(words)});
    throw end_of_reading{};
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor)
      refuse(mark, "anchors (&) are not taken; leave it out");
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag != plain_tag)
      refuse(mark, "tags (!) are not taken; what is in quotes is text");
  }

  static void go_on(bool wanted) {
    if (!wanted)
      throw end_of_reading{};
  }

  /// True if what comes is the name of a member; the next one is its value.
  bool takes_name() {
    if (open_.empty() || !open_.back().is_mapping)
      return false;
    return std::exchange(open_.back().wants_name, !open_.back().wants_name);
  }

  void scalar(const YAML::Mark& mark, json value, size_t length) {
    const text_span at{offset(mark), offset(mark) + length};
    if (!takes_name())
      return go_on(to_.scalar(std::move(value), at));
    if (!value.is_string())
      refuse(mark, "expected a name, got " + shown_value(value)
                       + "; write it in quotes");
    go_on(to_.key(value.get<std::string>(), at));
  }

  void open(const YAML::Mark& mark, json empty) {
    const bool is_mapping = empty.is_object();
    if (takes_name())
      refuse(mark, "expected a name, got "
                       + std::string{is_mapping ? "an object" : "an array"});
    go_on(to_.open(std::move(empty), {offset(mark), offset(mark) + 1}));
    open_.push_back({is_mapping, is_mapping});
  }

  void close() {
    open_.pop_back();
    to_.close();
  }

  std::string_view text_;
  size_t skipped_;
  document_events& to_;
  std::vector<level> open_;
  bool has_document_ = false;
};

/// How many bytes there are before one that YAML does not allow: no part of
/// UTF-8, or a control character. The parser would take some of them for the
/// end of the text.
size_t readable_bytes(std::string_view text) {
  const auto is_control = [](char x) {
    return static_cast<unsigned char>(x) < ' ' && x != '\t' && x != '\n'
           && x != '\r';
  };
  const auto* first = std::find_if(text.begin(), text.end(), is_control);
  return std::min(static_cast<size_t>(first - text.begin()),
                  valid_utf8_prefix(text));
}

/// The parser's words without what it quotes, which may be long.
std::string syntax_text(std::string words) {
  words.erase(std::min(words.find(": "), words.size()));
  return words;
}

bool read_all(std::string_view text, document_events& to) {
  const bool has_mark =
      text.substr(0, byte_order_mark.size()) == byte_order_mark;
  const auto skipped = has_mark ? byte_order_mark.size() : 0;
  yaml_events events{text, skipped, to};
  try {
    std::istringstream input{std::string{text.substr(skipped)}};
    YAML::Parser parser{input};
    while (parser.HandleNextDocument(events)) {
      // A second document is refused by the events.
    }
    if (events.has_document())
      return true;
    to.fail({0, "the document is empty"});
  } catch (const YAML::Exception& e) {
    to.fail({events.offset(e.mark), syntax_text(e.msg)});
  } catch (const end_of_reading&) {
    // The events know why.
  }
  return false;
}

} // namespace

bool read_yaml(std::string_view text, document_events& events) {
  if (const auto n = readable_bytes(text); n < text.size()) {
    events.fail({n, "expected text in UTF-8 without control characters"});
    return false;
  }
  return read_all(text, events);
}

namespace {

constexpr std::string_view digits = "0123456789";

template <class... Words>
bool is_one_of(std::string_view text, Words... words) {
  return ((text == words) || ...);
}

bool consists_of(std::string_view text, std::string_view characters) {
  return !text.empty()
         && text.find_first_not_of(characters) == std::string_view::npos;
}

/// The number that is all of `text`; none if there is no such, or if it does
/// not fit.
template <class Number, class... Form>
std::optional<json> number(std::string_view text, Form... form) {
  Number result{};
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, result, form...);
  if (error != std::errc{} || rest != end)
    return std::nullopt;
  return json(result);
}

/// Digits after an optional sign; as in JSON, what 64 bits cannot hold becomes
/// a floating-point number.
std::optional<json> decimal(std::string_view text) {
  if (auto result =
          text.front() == '-' ? number<int64_t>(text) : number<uint64_t>(text))
    return result;
  return number<double>(text);
}

/// True for what begins like a number and goes on as one to its end.
bool is_floating(std::string_view magnitude) {
  double ignored = 0;
  const auto* end = magnitude.data() + magnitude.size();
  return !magnitude.empty()
         && (digits.find(magnitude.front()) != std::string_view::npos
             || magnitude.front() == '.')
         && std::from_chars(magnitude.data(), end, ignored).ptr == end;
}

} // namespace

std::optional<json> plain_scalar(const std::string& text) {
  if (is_one_of(text, "", "~", "null", "Null", "NULL"))
    return json(nullptr);
  if (is_one_of(text, "true", "True", "TRUE"))
    return json(true);
  if (is_one_of(text, "false", "False", "FALSE"))
    return json(false);
  std::string_view signed_number = text;
  if (text.front() == '+')
    signed_number.remove_prefix(1);
  auto magnitude = signed_number;
  if (text.front() == '-')
    magnitude.remove_prefix(1);
  if (is_one_of(magnitude, ".inf", ".Inf", ".INF")
      || is_one_of(text, ".nan", ".NaN", ".NAN"))
    return std::nullopt;
  if (consists_of(magnitude, digits))
    return decimal(signed_number);
  const auto prefix = text.substr(0, 2);
  const auto rest = std::string_view{text}.substr(prefix.size());
  if (prefix == "0x" && consists_of(rest, "0123456789abcdefABCDEF"))
    return number<uint64_t>(rest, 16);
  if (prefix == "0o" && consists_of(rest, "01234567"))
    return number<uint64_t>(rest, 8);
  if (is_floating(magnitude))
    return number<double>(signed_number);
  return json(text);
}

} // namespace roscell
