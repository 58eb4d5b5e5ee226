// Makers of the table's rows: one for each kind of key, binding a name and a rule to a member.
//
// A member is bound by reference. `rule` texts complete the sentence "must be ...".
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/box.hpp"
#include "core/geometry/se3.hpp"
#include "daemon/config/key_table.hpp"
#include "daemon/config/value_text.hpp"

namespace hulltrack::keys {

/// The rule of a whole number, bound to nothing yet.
inline Key whole_rule(std::string name, std::int64_t min, std::int64_t max) {
  return {.name = std::move(name),
          .allowed = "a whole number from " + std::to_string(min) + " to " + std::to_string(max),
          .legal =
              [=](const ConfigValue& value) {
                const auto given = std::get<std::int64_t>(value);
                return given >= min && given <= max;
              },
          .get = {},
          .set = {}};
}

template <std::integral T>
Key whole(std::string name, T& member, std::int64_t min, std::int64_t max) {
  Key key = whole_rule(std::move(name), min, max);
  key.get = [&member] { return static_cast<std::int64_t>(member); };
  key.set = [&member](const ConfigValue& value) { member = static_cast<T>(std::get<std::int64_t>(value)); };
  return key;
}

/// Whole milliseconds.
inline Key milliseconds(std::string name, Nanoseconds& member, std::int64_t min, std::int64_t max) {
  Key key = whole_rule(std::move(name), min, max);
  key.allowed += " (ms)";
  key.get = [&member] {
    return std::int64_t{std::chrono::duration_cast<std::chrono::milliseconds>(member).count()};
  };
  key.set = [&member](const ConfigValue& value) {
    member = std::chrono::milliseconds(std::get<std::int64_t>(value));
  };
  return key;
}

inline Key number(std::string name, double& member, double min, double max, const char* unit = "") {
  return {.name = std::move(name),
          .allowed = "a number from " + number_text(min) + " to " + number_text(max) +
                     (*unit != '\0' ? std::string(" (") + unit + ")" : ""),
          .legal =
              [=](const ConfigValue& value) {
                const double given = std::get<double>(value);
                return given >= min && given <= max;
              },
          .get = [&member] { return member; },
          .set = [&member](const ConfigValue& value) { member = std::get<double>(value); }};
}

/// A number, or 0 for none; min > 0.
Key optional_number(std::string name, std::optional<double>& member, double min, double max,
                    const char* unit);

/// An angle in degrees that has been through radians, without the digits that this cost it.
[[nodiscard]] inline double tidy_degrees(double rad) {
  return std::round(degrees(rad) * 1e10) / 1e10 + 0.0;  // never -0
}

/// A member in radians that the file gives in degrees.
inline Key angle(std::string name, double& member, double min_deg, double max_deg) {
  Key key = number(std::move(name), member, min_deg, max_deg, "deg");
  key.get = [&member] { return tidy_degrees(member); };
  key.set = [&member](const ConfigValue& value) { member = radians(std::get<double>(value)); };
  return key;
}

inline Key flag(std::string name, bool& member) {
  return {.name = std::move(name),
          .allowed = "true or false",
          .legal = [](const ConfigValue&) { return true; },
          .get = [&member] { return member; },
          .set = [&member](const ConfigValue& value) { member = std::get<bool>(value); }};
}

inline Key text(std::string name, std::string& member, std::string allowed,
                std::function<bool(const std::string&)> legal) {
  return {.name = std::move(name),
          .allowed = std::move(allowed),
          .legal = [legal = std::move(legal)](
                       const ConfigValue& value) { return legal(std::get<std::string>(value)); },
          .get = [&member] { return member; },
          .set = [&member](const ConfigValue& value) { member = std::get<std::string>(value); }};
}

/// One of `words`; the member's value is the word's index.
template <typename E>
requires std::is_enum_v<E> Key choice(std::string name, E& member, std::span<const std::string_view> words) {
  const auto index = [words](const ConfigValue& value) {
    return std::find(words.begin(), words.end(), std::get<std::string>(value)) - words.begin();
  };
  return {.name = std::move(name),
          .allowed = list_text(words),
          .legal = [=](const ConfigValue& value) { return index(value) < std::ssize(words); },
          .get = [&member, words] { return std::string(words[static_cast<std::size_t>(member)]); },
          .set = [&member, index](const ConfigValue& value) { member = static_cast<E>(index(value)); },
          .words = {words.begin(), words.end()}};
}

/// Three numbers, each within +-limit, seen through a getter and a setter of a vector.
template <typename Get, typename Set>
Key vector3(std::string name, double limit, const char* unit, Get get, Set set) {
  return {.name = std::move(name),
          .allowed =
              "three numbers from " + number_text(-limit) + " to " + number_text(limit) + " (" + unit + ")",
          .legal =
              [limit](const ConfigValue& value) {
                const auto& numbers = std::get<Numbers>(value);
                return numbers.size() == 3 && std::all_of(numbers.begin(), numbers.end(),
                                                          [limit](double n) { return std::abs(n) <= limit; });
              },
          .get =
              [get] {
                const Eigen::Vector3d v = get();
                return Numbers(v.begin(), v.end());
              },
          .set =
              [set](const ConfigValue& value) {
                const auto& numbers = std::get<Numbers>(value);
                set(Eigen::Vector3d(numbers[0], numbers[1], numbers[2]));
              }};
}

/// The two keys of an installation transform: { xyz = [..], rpy_deg = [..] }.
std::vector<Key> pose(Pose& member);

/// Six numbers x0,y0,z0,x1,y1,z1 with x0 <= x1 and so on.
[[nodiscard]] bool is_box(const Numbers& numbers);
inline constexpr const char* kBoxAllowed = "six numbers [x0, y0, z0, x1, y1, z1], the lower corner first (m)";

Key box(std::string name, Box& member);
/// A box, or an empty list for none.
Key optional_box(std::string name, std::optional<Box>& member);
/// A list of boxes.
Key boxes(std::string name, std::vector<std::array<double, 6>>& member, std::size_t most);

}  // namespace hulltrack::keys
