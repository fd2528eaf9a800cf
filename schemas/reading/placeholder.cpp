#include "schemas/reading/placeholder.hpp"

#include <cstdint>

namespace roscell {

namespace {

std::string word_for(std::string_view name) {
  return "${" + std::string{name} + "}";
}

/// Whether what is at `at` stands for itself.
bool is_escaped(const std::string& text, size_t at) {
  return at > 0 && text[at - 1] == '$';
}

std::string filled(const std::string& text, const std::string& word,
                   const std::string& value) {
  std::string result;
  size_t done = 0;
  for (auto at = text.find(word); at != std::string::npos;
       at = text.find(word, done)) {
    const bool escaped = at > done && is_escaped(text, at);
    result.append(text, done, at - done - (escaped ? 1 : 0));
    result += escaped ? word : value;
    done = at + word.size();
  }
  return result.append(text, done, std::string::npos);
}

/// @param lone What a text becomes that is the word alone.
void fill(json& x, const std::string& word, const std::string& value,
          const json& lone) {
  if (x.is_structured()) {
    for (auto& member : x)
      fill(member, word, value, lone);
  } else if (x.is_string()) {
    const auto& text = x.get_ref<const std::string&>();
    if (text == word)
      x = lone;
    else if (text.find(word) != std::string::npos)
      x = filled(text, word, value);
  }
}

} // namespace

void fill_placeholder(json& document, std::string_view name,
                      const std::string& text) {
  fill(document, word_for(name), text, text);
}

void fill_placeholder(json& document, std::string_view name, int64_t number) {
  fill(document, word_for(name), std::to_string(number), number);
}

bool has_placeholder(const std::string& text, std::string_view name) {
  const auto word = word_for(name);
  for (auto at = text.find(word); at != std::string::npos;
       at = text.find(word, at + word.size()))
    if (!is_escaped(text, at))
      return true;
  return false;
}

} // namespace roscell
