#include "tools/roscell/view/graph/drawing.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/graph/canvas.hpp"
#include "tools/roscell/view/graph/group_layout.hpp"
#include "tools/roscell/view/graph/layers.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace roscell::cli {

namespace {

using text_boxes = std::vector<std::vector<std::string>>;

constexpr size_t group_gap = 4;

/// Draws one group, layer by layer.
class group_drawing {
public:
  group_drawing(const group_layout& what, const text_boxes& boxes)
      : what_{what}, boxes_{boxes} {
    for (size_t i = 0; i < what.layers.size(); ++i) {
      draw_layer(what.layers[i]);
      if (!what.bands[i].empty())
        draw_band(what.layers[i], what.layers[i + 1], what.bands[i]);
    }
  }

  std::string text() const {
    return sheet_.str();
  }

private:
  void draw_layer(const std::vector<placed_box>& row) {
    size_t lines = 0;
    for (const auto& x : row)
      if (!x.passage)
        lines = std::max(lines, boxes_[x.box].size());
    for (const auto& x : row) {
      if (x.passage) {
        sheet_.line(x.left, top_, x.left, top_ + lines + 1);
        continue;
      }
      sheet_.frame(x.left, top_, x.left + x.width - 1, top_ + lines + 1);
      for (size_t i = 0; i < boxes_[x.box].size(); ++i)
        sheet_.text(x.left + 2, top_ + 1 + i,
                    shortened(boxes_[x.box][i], x.width - 4));
    }
    top_ += lines + 1;
  }

  /// Where the arrows leave or reach the places of a layer: spread over each
  /// place, those that leave at even columns and those that come at odd ones,
  /// so that no two of them run in one column.
  static std::vector<size_t> ports(const std::vector<placed_box>& row,
                                   const std::vector<arrow_part>& band,
                                   size_t arrow_part::*end, size_t parity) {
    std::map<size_t, size_t> count;
    std::map<size_t, size_t> used;
    for (const auto& x : band)
      ++count[x.*end];
    std::vector<size_t> result;
    for (const auto& x : band) {
      const auto& place = row[x.*end];
      const auto number = ++used[x.*end];
      auto column = place.left + place.width * number / (count[x.*end] + 1);
      if (!place.passage && column % 2 != parity)
        ++column;
      result.push_back(column);
    }
    return result;
  }

  void draw_band(const std::vector<placed_box>& upper,
                 const std::vector<placed_box>& lower,
                 const std::vector<arrow_part>& band) {
    auto begin = ports(upper, band, &arrow_part::from, 0);
    auto end = ports(lower, band, &arrow_part::to, 1);
    straighten(lower, band, begin, end);
    const auto labels = band.size() == 1 ? band[0].labels.size() : 0;
    size_t bends = 0;
    for (size_t i = 0; i < band.size(); ++i)
      bends += begin[i] == end[i] ? 0 : 1;
    const auto bottom = top_ + std::max<size_t>(2, labels + bends + 1);
    auto track = top_ + labels;
    for (size_t i = 0; i < band.size(); ++i) {
      if (begin[i] != end[i])
        ++track;
      sheet_.line(begin[i], top_, begin[i], track);
      sheet_.line(begin[i], track, end[i], track);
      sheet_.line(end[i], track, end[i], bottom);
      if (band[i].ends)
        sheet_.text(end[i], bottom, "▼");
    }
    for (size_t i = 0; i < labels; ++i)
      sheet_.text(begin[0] + 2, top_ + 1 + i,
                  shortened(band[0].labels[i],
                            what_.width - std::min(what_.width, begin[0] + 2)));
    top_ = bottom;
  }

  /// An arrow whose target is just below goes straight down.
  static void straighten(const std::vector<placed_box>& lower,
                         const std::vector<arrow_part>& band,
                         const std::vector<size_t>& begin,
                         std::vector<size_t>& end) {
    for (size_t i = 0; i < band.size(); ++i) {
      const auto& place = lower[band[i].to];
      if (begin[i] > place.left && begin[i] + 1 < place.left + place.width)
        end[i] = begin[i];
    }
  }

  const group_layout& what_;
  const text_boxes& boxes_;
  canvas sheet_;
  size_t top_ = 0;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> result;
  for (size_t at = 0; at < text.size();) {
    const auto end = text.find('\n', at);
    result.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return result;
}

/// Groups side by side, each in so many columns.
std::string beside(const std::vector<std::pair<std::string, size_t>>& groups) {
  std::vector<std::string> result;
  size_t left = 0;
  for (const auto& [text, width] : groups) {
    const auto lines = lines_of(text);
    result.resize(std::max(result.size(), lines.size()));
    for (size_t i = 0; i < lines.size(); ++i) {
      const auto used = display_width(result[i]);
      result[i] += std::string(left - std::min(left, used), ' ') + lines[i];
    }
    left += width + group_gap;
  }
  return joined(result, "\n") + "\n";
}

} // namespace

std::string drawing(const text_boxes& boxes,
                    const std::vector<drawn_arrow>& arrows, size_t width) {
  std::vector<graph_arc> arcs;
  arcs.reserve(arrows.size());
  for (const auto& x : arrows)
    arcs.emplace_back(x.from, x.to);
  std::string result;
  std::vector<std::pair<std::string, size_t>> row;
  size_t used = 0;
  const auto end_row = [&] {
    result += row.empty() ? "" : (result.empty() ? "" : "\n") + beside(row);
    row.clear();
    used = 0;
  };
  for (const auto& members : components(boxes.size(), arcs)) {
    const auto layout = laid_out(members, boxes, arrows, width);
    if (!layout.fits)
      return {};
    if (used + layout.width > width)
      end_row();
    row.emplace_back(group_drawing{layout, boxes}.text(), layout.width);
    used += layout.width + group_gap;
  }
  end_row();
  return result;
}

} // namespace roscell::cli
