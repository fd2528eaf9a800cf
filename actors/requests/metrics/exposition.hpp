#pragma once

#include "actors/core/metric_table.hpp"

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roscell {

/// How metrics are written down: the older text format of Prometheus, or
/// OpenMetrics 1.0 (https://prometheus.io/docs/specs/om/open_metrics_spec).
enum class exposition_format { text, open_metrics };

/// What an HTTP client wants, by its Accept header.
exposition_format format_for(std::string_view accept);

const char* content_type_of(exposition_format format);

/// What tells the samples of a family apart, as it is written between braces.
class sample_labels {
public:
  using label = std::pair<std::string_view, std::string_view>;

  sample_labels() = default;
  sample_labels(std::initializer_list<label> all);

  void add(std::string_view name, std::string_view value);

  const std::string& text() const {
    return text_;
  }

private:
  std::string text_;
};

/// Writes families of samples, one after the other.
class exposition {
public:
  explicit exposition(exposition_format format) : format_(format) {}

  /// Begins a family. A counter's name has no ending.
  void gauge(std::string_view name, std::string_view help);
  void counter(std::string_view name, std::string_view help);
  void histogram(std::string_view name, std::string_view help,
                 const std::vector<double>& bounds);

  /// One sample of the gauge or counter that was begun last.
  void sample(const sample_labels& of, double value);

  /// All samples of one set of labels of the histogram that was begun last.
  /// `counts` has one number more than its bounds, of what lies beyond, and
  /// none includes another.
  void buckets(const sample_labels& of, const std::vector<uint64_t>& counts,
               double sum);

  /// All of what a table has of a family.
  void write(metric which, const metric_table& table);

  /// The whole text; nothing may follow.
  std::string finish();

private:
  void begin(std::string_view name, std::string_view help, const char* type);
  void line(std::string_view ending, std::string_view labels, double value);

  exposition_format format_;
  std::string name_;        ///< Of the family that was begun.
  const char* ending_ = ""; ///< Of its samples.
  /// The labels of its buckets, the last of which has no bound.
  std::vector<std::string> bounds_;
  std::string text_;
};

} // namespace roscell
