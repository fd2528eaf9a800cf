#include "actors/requests/metrics/exposition.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace roscell {

namespace {

/// The shortest text that reads back as the same number.
std::string number(double value) {
  if (std::isinf(value))
    return value > 0 ? "+Inf" : "-Inf";
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

/// A bucket's bound. A label is text, so that all who expose a number have to
/// write it alike; OpenMetrics wants the point in whole ones, too.
std::string bound_text(double bound, exposition_format format) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), bound,
                                 std::chars_format::general);
  std::string result{text.data(), end.ptr};
  if (format == exposition_format::open_metrics
      && result.find_first_of(".e") == std::string::npos)
    result += ".0";
  return result;
}

void append_escaped(std::string& to, std::string_view value) {
  if (value.find_first_of("\\\"\n") == std::string_view::npos) {
    to += value;
    return;
  }
  for (const char c : value) {
    if (c == '\\' || c == '"')
      to += '\\';
    if (c == '\n')
      to += "\\n";
    else
      to += c;
  }
}

} // namespace

exposition_format format_for(std::string_view accept) {
  return accept.find("application/openmetrics-text") != std::string_view::npos
             ? exposition_format::open_metrics
             : exposition_format::text;
}

const char* content_type_of(exposition_format format) {
  return format == exposition_format::open_metrics
             ? "application/openmetrics-text; version=1.0.0; charset=utf-8"
             : "text/plain; version=0.0.4; charset=utf-8";
}

sample_labels::sample_labels(std::initializer_list<label> all) {
  for (const auto& [name, value] : all)
    add(name, value);
}

void sample_labels::add(std::string_view name, std::string_view value) {
  if (!text_.empty())
    text_ += ',';
  text_.append(name).append("=\"");
  append_escaped(text_, value);
  text_ += '"';
}

/// OpenMetrics names a counter's family without the ending of its samples.
void exposition::begin(std::string_view name, std::string_view help,
                       const char* type) {
  name_ = name;
  std::string family{name};
  if (format_ == exposition_format::text)
    family += ending_;
  text_.append("# HELP ").append(family).append(" ").append(help).append("\n");
  text_.append("# TYPE ").append(family).append(" ").append(type).append("\n");
}

void exposition::gauge(std::string_view name, std::string_view help) {
  ending_ = "";
  begin(name, help, "gauge");
}

void exposition::counter(std::string_view name, std::string_view help) {
  ending_ = "_total";
  begin(name, help, "counter");
}

void exposition::histogram(std::string_view name, std::string_view help,
                           const std::vector<double>& bounds) {
  ending_ = "";
  begin(name, help, "histogram");
  bounds_.clear();
  bounds_.reserve(bounds.size() + 1);
  for (const auto bound : bounds)
    bounds_.push_back("le=\"" + bound_text(bound, format_) + '"');
  bounds_.emplace_back("le=\"+Inf\"");
}

void exposition::sample(const sample_labels& of, double value) {
  line(ending_, of.text(), value);
}

void exposition::line(std::string_view ending, std::string_view labels,
                      double value) {
  text_.append(name_).append(ending);
  if (!labels.empty())
    text_.append("{").append(labels).append("}");
  text_.append(" ").append(number(value)).append("\n");
}

/// The count that is written for a bucket includes those of the smaller ones.
void exposition::buckets(const sample_labels& of,
                         const std::vector<uint64_t>& counts, double sum) {
  const auto& shared = of.text();
  std::string labels = shared.empty() ? "" : shared + ',';
  const auto prefix = labels.size();
  uint64_t count = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    count += counts[i];
    labels.replace(prefix, std::string::npos, bounds_[i]);
    line("_bucket", labels, static_cast<double>(count));
  }
  line("_count", shared, static_cast<double>(count));
  line("_sum", shared, sum);
}

void exposition::write(metric which, const metric_table& table) {
  const auto& family = metric_families()[static_cast<size_t>(which)];
  const bool is_counter = family.buckets.empty();
  if (is_counter)
    counter(family.name, family.help);
  else
    histogram(family.name, family.help, family.buckets);
  for (const auto& x : table.samples(which)) {
    sample_labels of;
    for (size_t i = 0; i < x.labels.size(); ++i)
      of.add(family.labels[i], x.labels[i]);
    if (is_counter)
      sample(of, x.sum);
    else
      buckets(of, x.counts, x.sum);
  }
}

std::string exposition::finish() {
  if (format_ == exposition_format::open_metrics)
    text_ += "# EOF\n";
  return std::move(text_);
}

} // namespace roscell
