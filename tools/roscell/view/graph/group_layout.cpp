#include "tools/roscell/view/graph/group_layout.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/graph/layers.hpp"

#include <algorithm>
#include <map>

namespace roscell::cli {

namespace {

constexpr size_t box_gap = 3;
constexpr size_t frame_width = 4; ///< Two lines and two blanks.
constexpr size_t least_box = 12;

size_t natural_width(const std::vector<std::string>& lines) {
  size_t result = 0;
  for (const auto& line : lines)
    result = std::max(result, display_width(line));
  return result + frame_width;
}

/// Puts boxes into layers and cuts arrows into parts from layer to layer.
class layering {
public:
  layering(const std::vector<size_t>& members,
           const std::vector<drawn_arrow>& arrows,
           const std::vector<size_t>& layer_of)
      : layer_of_{layer_of} {
    for (const auto box : members)
      put(layer_of[box], {box, false, 0, 0});
    result.bands.resize(result.layers.size());
    for (const auto& arrow : arrows)
      if (place_.count(arrow.from) > 0
          && layer_of[arrow.from] < layer_of[arrow.to])
        cut(arrow);
  }

  group_layout result;

private:
  size_t put(size_t layer, placed_box what) {
    if (result.layers.size() <= layer)
      result.layers.resize(layer + 1);
    auto& row = result.layers[layer];
    if (!what.passage)
      place_[what.box] = row.size();
    row.push_back(what);
    return row.size() - 1;
  }

  void cut(const drawn_arrow& arrow) {
    auto from = place_[arrow.from];
    for (auto layer = layer_of_[arrow.from]; layer < layer_of_[arrow.to];
         ++layer) {
      const bool ends = layer + 1 == layer_of_[arrow.to];
      const auto to = ends ? place_[arrow.to] : put(layer + 1, {0, true, 0, 1});
      const bool begins = layer == layer_of_[arrow.from];
      result.bands[layer].push_back(
          {from, to, ends, begins ? arrow.labels : std::vector<std::string>{}});
      from = to;
    }
  }

  const std::vector<size_t>& layer_of_;
  std::map<size_t, size_t> place_; ///< In its layer, of each box.
};

/// Brings each layer into the order of what leads to it from above.
void untangle(group_layout& x) {
  for (size_t layer = 1; layer < x.layers.size(); ++layer) {
    auto& row = x.layers[layer];
    std::vector<double> sum(row.size(), 0);
    std::vector<double> count(row.size(), 0);
    for (const auto& part : x.bands[layer - 1]) {
      sum[part.to] += static_cast<double>(part.from);
      ++count[part.to];
    }
    std::vector<size_t> order(row.size());
    for (size_t i = 0; i < order.size(); ++i)
      order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      return sum[a] * std::max(1.0, count[b])
             < sum[b] * std::max(1.0, count[a]);
    });
    std::vector<placed_box> sorted;
    std::vector<size_t> place(row.size());
    for (const auto i : order) {
      place[i] = sorted.size();
      sorted.push_back(row[i]);
    }
    row = sorted;
    for (auto& part : x.bands[layer - 1])
      part.to = place[part.to];
    for (auto& part : x.bands[layer])
      part.from = place[part.from];
  }
}

/// Gives each place of a layer its width; false if they cannot be so narrow.
bool measure(std::vector<placed_box>& row,
             const std::vector<std::vector<std::string>>& boxes, size_t width) {
  size_t spare = box_gap * (row.size() - 1);
  size_t count = 0;
  size_t wanted = 0;
  for (auto& x : row) {
    x.width = x.passage ? 1 : natural_width(boxes[x.box]);
    (x.passage ? spare : wanted) += x.width;
    count += x.passage ? 0 : 1;
  }
  if (spare + wanted <= width)
    return true;
  if (spare + count * least_box > width)
    return false;
  for (auto& x : row)
    if (!x.passage)
      x.width = std::min(x.width, (width - spare) / count);
  return true;
}

size_t total(const std::vector<placed_box>& row) {
  size_t result = box_gap * (row.size() - 1);
  for (const auto& x : row)
    result += x.width;
  return result;
}

/// The labels of the only arrow of a band stand at its right.
size_t label_width(const std::vector<arrow_part>& band) {
  size_t result = 0;
  if (band.size() == 1)
    for (const auto& label : band[0].labels)
      result = std::max(result, display_width(label) + 2);
  return result;
}

} // namespace

group_layout laid_out(const std::vector<size_t>& members,
                      const std::vector<std::vector<std::string>>& boxes,
                      const std::vector<drawn_arrow>& arrows, size_t width) {
  std::vector<graph_arc> arcs;
  arcs.reserve(arrows.size());
  for (const auto& x : arrows)
    arcs.emplace_back(x.from, x.to);
  auto result = layering{members, arrows, layers(boxes.size(), arcs)}.result;
  untangle(result);
  for (auto& row : result.layers) {
    result.fits = measure(row, boxes, width) && result.fits;
    result.width = std::max(result.width, total(row));
  }
  const auto boxes_width = result.width;
  for (size_t i = 0; i < result.layers.size(); ++i) {
    auto left =
        (boxes_width - std::min(boxes_width, total(result.layers[i]))) / 2;
    for (auto& x : result.layers[i]) {
      x.left = left;
      left += x.width + box_gap;
    }
    const auto labelled = boxes_width / 2 + label_width(result.bands[i]) + 1;
    result.width = std::min(width, std::max(result.width, labelled));
  }
  result.fits = result.fits && boxes_width <= width;
  return result;
}

} // namespace roscell::cli
