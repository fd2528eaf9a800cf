#pragma once

#include <string>
#include <vector>

namespace roscell::allocation {

/// Cores with at least one decimal: "2.0", "0.125".
std::string cores(double amount);

/// MiB without needless decimals: "512", "0.5".
std::string mebibytes(double amount);

/// The word in single quotes, as names are written in sentences.
std::string quoted(const std::string& word);

/// "a", "a and b", "a, b and c".
std::string enumerated(const std::vector<std::string>& words);

} // namespace roscell::allocation
