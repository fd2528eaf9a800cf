#pragma once

#include "actors/house/metric_book.hpp"

#include <cstdint>
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

/// Writes families of samples, one after the other.
class exposition {
public:
  using labels = std::vector<std::pair<std::string_view, std::string_view>>;

  explicit exposition(exposition_format format) : format_(format) {}

  /// Begins a family. A counter's name has no ending.
  void gauge(std::string_view name, std::string_view help);
  void counter(std::string_view name, std::string_view help);
  void histogram(std::string_view name, std::string_view help);

  /// One sample of the gauge or counter that was begun last.
  void sample(const labels& of, double value);

  /// All samples of one set of labels of the histogram that was begun last.
  /// `counts` has one number more than `bounds`, of what lies beyond, and none
  /// includes another.
  void buckets(const labels& of, const std::vector<double>& bounds,
               const std::vector<uint64_t>& counts, double sum);

  /// All of what a book has of a family.
  void write(metric which, const metric_book& book);

  /// The whole text; nothing may follow.
  std::string finish();

private:
  void begin(std::string_view name, std::string_view help, const char* type);
  void line(std::string_view ending, const labels& of, double value);

  exposition_format format_;
  std::string name_;        ///< Of the family that was begun.
  const char* ending_ = ""; ///< Of its samples.
  std::string text_;
};

} // namespace roscell
