#include "brute_force.hpp"

#include <algorithm>
#include <cmath>

namespace oracle {

namespace {

using allocation = std::vector<pick>;

double left(const capacity& of) {
  return of.u >= of.c ? 0.0 : of.c - of.u;
}

const way& way_of(const instance& in, const allocation& a, std::size_t i) {
  return in.tasks[i].ways[static_cast<std::size_t>(a[i].d)];
}

const machine& machine_of(const instance& in, const pick& p) {
  return in.machines[static_cast<std::size_t>(p.v)];
}

/// Sum of r over the first `end` steps that are on node v.
template <class Request>
double sum_on(const instance& in, const allocation& a, std::size_t end, int v,
              Request r) {
  double sum = 0;
  for (std::size_t i = 0; i < end; ++i)
    if (a[i].v == v)
      sum += r(way_of(in, a, i));
  return sum;
}

double gmem_on(const instance& in, const allocation& a, std::size_t end, int v,
               int g) {
  double sum = 0;
  for (std::size_t i = 0; i < end; ++i)
    if (a[i].v == v && a[i].g == g)
      sum += way_of(in, a, i).gmem;
  return sum;
}

double cpu_of(const way& d) {
  return d.cpu;
}
double mem_of(const way& d) {
  return d.mem;
}
double disk_of(const way& d) {
  return d.disk;
}
double pool_of(const way& d) {
  return d.mem + d.gmem;
}

/// Equation (3), for the node of the last step of `a`.
bool constraints_hold(const instance& in, const allocation& a) {
  const double eps = 1e-9;
  auto n = a.size();
  auto v = a.back().v;
  const auto& m = machine_of(in, a.back());
  if (sum_on(in, a, n, v, cpu_of) > left(m.cpu) + eps)
    return false;
  if (sum_on(in, a, n, v, disk_of) > left(m.disk) + eps)
    return false;
  if (m.um)
    return sum_on(in, a, n, v, pool_of) <= left(m.mem) + eps;
  if (sum_on(in, a, n, v, mem_of) > left(m.mem) + eps)
    return false;
  for (std::size_t g = 0; g < m.gmem.size(); ++g)
    if (gmem_on(in, a, n, v, static_cast<int>(g)) > left(m.gmem[g]) + eps)
      return false;
  return true;
}

double divided(double r, double denominator) {
  return r == 0 ? 0 : r / denominator;
}

/// Equation (4) for step i, and its variance in equation (1).
details step_details(const instance& in, const allocation& a, std::size_t i) {
  const auto& d = way_of(in, a, i);
  const auto& m = machine_of(in, a[i]);
  auto v = a[i].v;
  details out;
  out.f.push_back(divided(d.cpu, left(m.cpu) - sum_on(in, a, i, v, cpu_of)));
  if (m.um) {
    auto pool = left(m.mem) - sum_on(in, a, i, v, pool_of);
    out.f.push_back(divided(d.mem, d.gpu ? pool - d.gmem : pool));
  } else {
    out.f.push_back(divided(d.mem, left(m.mem) - sum_on(in, a, i, v, mem_of)));
  }
  out.f.push_back(divided(d.disk, left(m.disk) - sum_on(in, a, i, v, disk_of)));
  if (d.gpu && m.um)
    out.f.push_back(
        divided(d.gmem, left(m.mem) - sum_on(in, a, i, v, pool_of) - d.mem));
  if (d.gpu && !m.um)
    out.f.push_back(
        divided(d.gmem, left(m.gmem[static_cast<std::size_t>(a[i].g)])
                            - gmem_on(in, a, i, v, a[i].g)));
  double mean = 0;
  for (auto f : out.f)
    mean += f / static_cast<double>(out.f.size());
  for (auto f : out.f)
    out.variance += std::pow(f - mean, 2) / static_cast<double>(out.f.size());
  return out;
}

/// sigma_load of equation (1), with the loads of equation (2).
double load_variance(const instance& in, const allocation& a) {
  std::vector<double> loads;
  for (int v = 0; v < static_cast<int>(in.machines.size()); ++v) {
    if (std::none_of(a.begin(), a.end(), [&](auto p) { return p.v == v; }))
      continue;
    const auto& m = in.machines[static_cast<std::size_t>(v)];
    auto cpu = std::min(m.cpu.u, m.cpu.c) + sum_on(in, a, a.size(), v, cpu_of);
    auto mem = std::min(m.mem.u, m.mem.c) + sum_on(in, a, a.size(), v, mem_of);
    loads.push_back(0.5 * (cpu / m.cpu.c + mem / m.mem.c));
  }
  double mean = 0, variance = 0;
  for (auto l : loads)
    mean += l / static_cast<double>(loads.size());
  for (auto l : loads)
    variance += (l - mean) * (l - mean) / static_cast<double>(loads.size());
  return variance;
}

bool contains_all(const std::vector<std::string>& have,
                  const std::vector<std::string>& want) {
  return std::all_of(want.begin(), want.end(), [&](const auto& one) {
    return std::find(have.begin(), have.end(), one) != have.end();
  });
}

bool runs_on(const instance& in, int i, const way& d, int v) {
  const auto& m = in.machines[static_cast<std::size_t>(v)];
  return m.cpu.c > 0 && m.mem.c > 0
         && in.tasks[static_cast<std::size_t>(i)]
                .skill[static_cast<std::size_t>(v)]
         && (d.archs.empty() || contains_all(d.archs, {m.arch}))
         && contains_all(m.tags, d.tags);
}

struct enumeration {
  const instance& in;
  std::vector<std::vector<pick>> c;
  std::vector<allocation> all;
  std::vector<double> totals;

  double total(const allocation& a) const {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += step_details(in, a, i).variance
             + (way_of(in, a, i).gpu ? in.beta : 0);
    return sum / static_cast<double>(a.size())
           + in.alpha * load_variance(in, a);
  }

  bool is_apart(const allocation& a, const pick& p) const {
    auto number = in.tasks[a.size()].together;
    for (std::size_t i = 0; number != 0 && i < a.size(); ++i)
      if (in.tasks[i].together == number && a[i].v != p.v)
        return true;
    return false;
  }

  void extend(allocation& a) {
    if (a.size() == in.tasks.size()) {
      all.push_back(a);
      totals.push_back(total(a));
      return;
    }
    for (const auto& p : c[a.size()]) {
      if (is_apart(a, p))
        continue;
      a.push_back(p);
      if (constraints_hold(in, a))
        extend(a);
      a.pop_back();
    }
  }
};

} // namespace

std::vector<pick> compatible(const instance& in, int i) {
  std::vector<pick> found;
  const auto& t = in.tasks[static_cast<std::size_t>(i)];
  for (int v = 0; v < static_cast<int>(in.machines.size()); ++v)
    for (int d = 0; d < static_cast<int>(t.ways.size()); ++d) {
      const auto& w = t.ways[static_cast<std::size_t>(d)];
      if (!runs_on(in, i, w, v))
        continue;
      auto gpus = static_cast<int>(
          in.machines[static_cast<std::size_t>(v)].gmem.size());
      for (int g = w.gpu ? 0 : -1; g < (w.gpu ? gpus : 0); ++g) {
        instance alone{in.machines, {t}, in.alpha, in.beta};
        if (constraints_hold(alone, {{v, d, g}}))
          found.push_back({v, d, g});
      }
    }
  return found;
}

std::vector<pick> compatible_together(const instance& in, int i) {
  auto found = compatible(in, i);
  auto number = in.tasks[static_cast<std::size_t>(i)].together;
  for (int j = 0; number != 0 && j < static_cast<int>(in.tasks.size()); ++j) {
    if (in.tasks[static_cast<std::size_t>(j)].together != number)
      continue;
    auto others = compatible(in, j);
    found.erase(std::remove_if(found.begin(), found.end(),
                               [&](const pick& p) {
                                 return std::none_of(
                                     others.begin(), others.end(),
                                     [&](const pick& q) { return q.v == p.v; });
                               }),
                found.end());
  }
  return found;
}

int all_candidates(const instance& in, int i) {
  int count = 0;
  for (const auto& m : in.machines)
    for (const auto& w : in.tasks[static_cast<std::size_t>(i)].ways)
      count += w.gpu ? std::max(1, static_cast<int>(m.gmem.size())) : 1;
  return count;
}

answer solve(const instance& in) {
  enumeration phi{in, {}, {}, {}};
  for (int i = 0; i < static_cast<int>(in.tasks.size()); ++i)
    phi.c.push_back(compatible(in, i));
  allocation start;
  phi.extend(start);
  answer out;
  out.feasible = !phi.all.empty();
  if (!out.feasible)
    return out;
  auto least = *std::min_element(phi.totals.begin(), phi.totals.end());
  std::size_t first = 0;
  while (phi.totals[first] > least + 1e-12)
    ++first;
  out.picks = phi.all[first];
  out.total = phi.totals[first];
  out.load = load_variance(in, out.picks);
  out.balance = out.total - in.alpha * out.load;
  for (std::size_t i = 0; i < out.picks.size(); ++i)
    out.steps.push_back(step_details(in, out.picks, i));
  return out;
}

} // namespace oracle
