#include "daemon/replay/reason_table.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

#include "core/base/text.hpp"

namespace hulltrack {
namespace {

constexpr std::size_t kShown = 12;  // kinds; more than a screen helps nobody

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Each number, with its sign and decimals, is a '#'. The digit of a name (Q1) stays.
std::string without_figures(const std::string& words) {
  std::string kind;
  for (std::size_t i = 0; i < words.size();) {
    const bool is_sign = words[i] == '-' && i + 1 < words.size() && is_digit(words[i + 1]);
    const bool in_name = i > 0 && std::isalpha(static_cast<unsigned char>(words[i - 1])) != 0;
    if ((!is_sign && !is_digit(words[i])) || in_name) {
      kind += words[i++];
      continue;
    }
    kind += '#';
    ++i;
    while (i < words.size() &&
           (is_digit(words[i]) || (words[i] == '.' && i + 1 < words.size() && is_digit(words[i + 1])))) {
      ++i;
    }
  }
  return kind;
}

}  // namespace

void ReasonTable::add(std::uint32_t frame, const std::string& reason) {
  Kind& kind = kinds_[without_figures(reason)];
  if (kind.count++ == 0) {
    kind.first_frame = frame;
    kind.first_words = reason;
  }
}

std::string ReasonTable::text(std::size_t frames) const {
  std::vector<Kind> kinds;
  for (const auto& [words, kind] : kinds_) {
    kinds.push_back(kind);
  }
  std::sort(kinds.begin(), kinds.end(), [](const Kind& a, const Kind& b) {
    return a.count != b.count ? a.count > b.count : a.first_frame < b.first_frame;
  });
  const auto share = [frames](std::size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(frames);
  };
  std::string text;
  std::size_t others = 0;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (i >= kShown) {
      others += kinds[i].count;
      continue;
    }
    text += format_text("%s%6.2f %%, first in frame %u: %s\n", i == 0 ? "health 0    " : "            ",
                        share(kinds[i].count), kinds[i].first_frame,
                        kinds[i].first_words.empty() ? "no reason was given" : kinds[i].first_words.c_str());
  }
  if (others > 0) {
    text += format_text("            %6.2f %% for %s\n", share(others),
                        counted(kinds.size() - kShown, "other reason").c_str());
  }
  return text;
}

}  // namespace hulltrack
