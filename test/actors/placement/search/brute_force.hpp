#pragma once

#include <string>
#include <vector>

/// Equations (1) to (4) of the paper written down once more, by enumeration.
/// It shares no type and no arithmetic with the library: an error would have
/// to be made twice to stay hidden.
namespace oracle {

struct capacity {
  double c = 0, u = 0;
};

struct machine {
  std::string arch;
  bool um = false;
  capacity cpu, mem, disk;
  std::vector<capacity> gmem; // GPU g is at position g
  std::vector<std::string> tags;
};

struct way {
  std::vector<std::string> archs, tags;
  double cpu = 0, mem = 0, disk = 0, gmem = 0;
  bool gpu = false;
};

struct task {
  std::vector<way> ways;
  std::vector<bool> skill; // per machine
  int together = 0;        // not 0: on one machine with its like
};

struct instance {
  std::vector<machine> machines;
  std::vector<task> tasks;
  double alpha = 0.1, beta = -0.01;
};

struct pick {
  int v = 0, d = 0, g = -1;
  bool operator==(const pick& o) const {
    return v == o.v && d == o.d && g == o.g;
  }
};

struct details {
  std::vector<double> f; // cpu, mem, disk and, with a GPU, gmem
  double variance = 0;
};

struct answer {
  bool feasible = false;
  std::vector<pick> picks;
  double total = 0, balance = 0, load = 0;
  std::vector<details> steps;
};

/// C_i: what is compatible when the task is alone, in the order of the tie
/// rule.
std::vector<pick> compatible(const instance& in, int i);

/// The same, on machines that each task which must be together with it can use.
std::vector<pick> compatible_together(const instance& in, int i);

/// All (node, deployment, GPU) of a task, compatible or not. A GPU deployment
/// counts once on a machine without GPU.
int all_candidates(const instance& in, int i);

answer solve(const instance& in);

} // namespace oracle
