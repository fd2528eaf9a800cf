#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// Numbers, amounts, times and lists as people read them.
namespace roscell {

/// At most `decimals` digits after the point and no trailing zeros; "-" for a
/// value that is not finite.
std::string format_number(double value, int decimals = 2);

/// So many significant digits, for numbers of any size: "0.25", "1.895e-07".
std::string format_significant(double value, int digits);

/// An amount in MiB without its unit: whole numbers from 10 on, one decimal
/// below.
std::string format_mib(double mib);

/// An amount in MiB with the unit that people read: "812 MiB", "23.5 GiB".
std::string format_memory(double mib);

/// Two amounts in MiB with the unit of the second: "0.8/3.8 GiB".
std::string format_memory(double used_mib, double capacity_mib);

/// A number of bytes with its binary unit, rounded as `format_mib` does:
/// "512 B", "1.5 KiB", "12 MiB".
std::string format_bytes(double bytes);

/// The two largest units: "42s", "3m05s", "2h10m", "5d03h". Less than nothing
/// is "0s".
std::string format_age(std::chrono::milliseconds age);

/// The age of what happened at `since_unix_ms`; "-" for a time that is not
/// known (0), "0s" for one to come, because the clocks of two machines differ.
std::string format_since(int64_t since_unix_ms, int64_t now_unix_ms);

/// The words in one line.
std::string joined(const std::vector<std::string>& words,
                   std::string_view between = ",");

/// Each name once, in order: "a,b".
std::string listed(const std::set<std::string>& names);

/// Labels and the like: "host=one,room=lab".
std::string listed(const std::map<std::string, std::string>& pairs);

} // namespace roscell
