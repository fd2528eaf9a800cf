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

void append_escaped(std::string& to, std::string_view value) {
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

void exposition::sample(const labels& of, double value) {
  line(ending_, of, value);
}

void exposition::line(std::string_view ending, const labels& of, double value) {
  text_.append(name_).append(ending);
  char before = '{';
  for (const auto& [key, text] : of) {
    text_ += before;
    text_.append(key).append("=\"");
    append_escaped(text_, text);
    text_ += '"';
    before = ',';
  }
  text_ += of.empty() ? " " : "} ";
  text_.append(number(value)).append("\n");
}

void exposition::write(metric which, const metric_book& book) {
  const auto& family = metric_families()[static_cast<size_t>(which)];
  if (family.buckets.empty()) {
    counter(family.name, family.help);
  } else {
    ending_ = "";
    begin(family.name, family.help, "histogram");
  }
  for (const auto& x : book.samples(which)) {
    if (!family.buckets.empty()) {
      histogram(family, x);
      continue;
    }
    labels of;
    for (size_t i = 0; i < x.labels.size(); ++i)
      of.emplace_back(family.labels[i], x.labels[i]);
    sample(of, x.sum);
  }
}

/// The count of a bucket includes those of the smaller ones.
void exposition::histogram(const metric_family& family,
                           const metric_sample& sample) {
  labels of;
  for (size_t i = 0; i < sample.labels.size(); ++i)
    of.emplace_back(family.labels[i], sample.labels[i]);
  uint64_t count = 0;
  for (size_t i = 0; i < sample.counts.size(); ++i) {
    count += sample.counts[i];
    const auto bound = i < family.buckets.size() ? number(family.buckets[i])
                                                 : std::string{"+Inf"};
    auto with_bound = of;
    with_bound.emplace_back("le", bound);
    line("_bucket", with_bound, static_cast<double>(count));
  }
  line("_count", of, static_cast<double>(count));
  line("_sum", of, sample.sum);
}

std::string exposition::finish() {
  if (format_ == exposition_format::open_metrics)
    text_ += "# EOF\n";
  return std::move(text_);
}

} // namespace roscell
