#include "daemon/config/nearest_name.hpp"

#include <algorithm>

namespace hulltrack {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Rows of the distance table: two back, one back, current.
  std::vector<std::size_t> older(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    older.swap(previous);
    previous.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({previous[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], older[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

std::optional<std::string> nearest_name(std::string_view written, const std::vector<std::string>& names) {
  constexpr std::size_t kLongest = 100;  // nobody means a known name with more than that
  std::optional<std::string> best;
  std::size_t best_distance = 0;
  if (written.size() > kLongest) {
    return best;
  }
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(written, name);
    const std::size_t allowed = std::max<std::size_t>(1, std::max(name.size(), written.size()) / 3);
    if (distance <= allowed && (!best || distance < best_distance)) {
      best = name;
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace hulltrack
