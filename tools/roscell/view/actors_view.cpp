#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/views.hpp"

#include <map>
#include <utility>

namespace roscell::cli {

namespace {

/// A node may tell anything: actors that would stand deeper stand at the top.
constexpr int most_levels = 16;

/// Each actor below the one that spawned it; at the top, if that has ended.
class actor_tree {
public:
  /// Parents come before their children in `actors`.
  explicit actor_tree(const std::vector<actor_row>& actors) {
    std::map<uint64_t, int> levels;
    for (const auto& x : actors) {
      const auto parent = levels.find(x.parent);
      // Ids rise; what has no lower one is no parent, and there are no circles.
      const bool below = parent != levels.end() && x.parent < x.id
                         && parent->second < most_levels;
      levels[x.id] = below ? parent->second + 1 : 1;
      children_[below ? x.parent : 0].push_back(&x);
    }
  }

  /// Calls `visit(row, drawn name)` for each actor, parents first.
  template <class Visit>
  void walk(Visit visit) {
    for (const auto* x : taken(0)) {
      visit(*x, x->name);
      walk_below(*x, "", visit);
    }
  }

private:
  using rows = std::vector<const actor_row*>;

  /// Those of one parent, once.
  rows taken(uint64_t parent) {
    auto node = children_.extract(parent);
    return node ? std::move(node.mapped()) : rows{};
  }

  template <class Visit>
  void walk_below(const actor_row& parent, const std::string& margin,
                  Visit& visit) {
    const auto below = taken(parent.id);
    for (const auto* x : below) {
      const bool last = x == below.back();
      visit(*x, margin + (last ? "└ " : "├ ") + x->name);
      walk_below(*x, margin + (last ? "  " : "│ "), visit);
    }
  }

  std::map<uint64_t, rows> children_;
};

std::string ms_text(uint64_t us) {
  return format_number(static_cast<double>(us) / 1000);
}

} // namespace

std::string actors_view(const std::vector<actor_row>& actors,
                        const view_style& style) {
  table t{{{"ACTOR"},
           {"ID", align::right},
           {"MESSAGES", align::right},
           {"WAITING", align::right},
           {"BUSY (ms)", align::right},
           {"LONGEST (ms)", align::right}},
          {}};
  actor_tree{actors}.walk([&t](const actor_row& x, const std::string& drawn) {
    t.rows.push_back({drawn, std::to_string(x.id), std::to_string(x.messages),
                      std::to_string(x.mailbox), ms_text(x.busy_us),
                      ms_text(x.longest_us)});
  });
  return t.render(style.text);
}

} // namespace roscell::cli
